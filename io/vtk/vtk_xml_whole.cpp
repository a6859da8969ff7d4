// SPDX-License-Identifier: BSD-3-Clause
#include "io/vtk/vtk_xml_whole.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <utility>

#include "cells/cell_block.hpp"

namespace tessera::io {
namespace {

void stream_whole(const system::PositionalFile& file, const VtkXmlWhole& whole, const std::string& source,
                  const system::ByteSink& use) {
  std::vector<std::byte> bits;
  for (const VtkXmlSegment& segment : whole.segments)
    stream_numbers(file, segment, static_cast<std::size_t>(whole.components), source,
                   [&](std::span<const std::byte> part) {
                     if (!whole.has_ghost_levels) return use(part);
                     bits.assign(part.begin(), part.end());
                     for (std::byte& level : bits) level = std::byte{level > std::byte{0}};
                     use(bits);
                   });
}

/// The fields of the first non-empty piece.
const VtkXmlFields& first_fields(const VtkXmlGrid& grid, const VtkXmlFieldsOf& kind) {
  const auto first = std::ranges::find_if(grid.pieces, [&](const VtkXmlPiece& piece) { return piece.*kind.count > 0; });
  return (first != grid.pieces.end() ? *first : grid.pieces.front()).*kind.fields;
}

/// Largest total size of point fields, or of cell fields, for which the values are kept when they are tallied, so that
/// they are decoded only once.
constexpr std::uint64_t most_decoded = 16 << 20;

void tally(const VtkXmlOpened& of, const VtkXmlWhole& whole, ForeignArray& field, VtkXmlDecoded* decoded) {
  std::array<double, 4096> some{};
  stream_whole(*of.file, whole, of.source, [&](std::span<const std::byte> bytes) {
    if (decoded != nullptr) decoded->insert(decoded->end(), bytes.begin(), bytes.end());
    const std::size_t tuples = bytes.size() / field.tuple_bytes();
    for (std::size_t first = 0; first < tuples; first += some.size()) {
      const std::span chunk(some.data(), std::min(some.size(), tuples - first));
      read_tuples(bytes, field.type, field.components, field.components == 1 ? 0 : cells::magnitude, first, chunk);
      field.tally.add(chunk);
    }
  });
}

}  // namespace

ForeignArray hold_whole(const VtkXmlOpened& of, VtkXmlWhole whole, ForeignArray as,
                        std::shared_ptr<const VtkXmlDecoded> decoded) {
  as.components = whole.components;
  std::uint64_t numbers = 0;
  for (const VtkXmlSegment& segment : whole.segments) {
    require_numbers(*of.file, segment, of.source);
    numbers += segment.numbers;
  }
  as.tuples = numbers / static_cast<std::uint64_t>(whole.components);
  return of.arrays->hold(std::move(as), [file = of.file, whole = std::move(whole), source = of.source,
                                         decoded = std::move(decoded)](const system::ByteSink& use) {
    if (decoded != nullptr && !decoded->empty())
      use(*decoded);
    else
      stream_whole(*file, whole, source, use);
  });
}

bool fields_agree(const VtkXmlGrid& grid, const VtkXmlFieldsOf& kind) {
  const VtkXmlFields& first = first_fields(grid, kind);
  return std::ranges::all_of(grid.pieces, [&](const VtkXmlPiece& piece) {
    return piece.*kind.count == 0 ||
           std::ranges::equal((piece.*kind.fields).arrays, first.arrays,
                              [](const VtkXmlArray& a, const VtkXmlArray& b) { return a.is_like(b); });
  });
}

std::vector<ForeignArray> hold_fields(const VtkXmlOpened& of, const VtkXmlFieldsOf& kind) {
  const VtkXmlFields& first = first_fields(of.grid, kind);
  std::vector<ForeignArray> fields;
  std::vector<VtkXmlWhole> wholes;
  std::vector<std::shared_ptr<VtkXmlDecoded>> decoded;
  std::uint64_t bytes = 0;
  for (std::size_t k = 0; k < first.arrays.size(); ++k) {
    const VtkXmlArray& like = first.arrays[k];
    if (!like.type) continue;
    VtkXmlWhole whole{{}, like.components};
    for (const VtkXmlPiece& piece : of.grid.pieces)
      if (const std::uint64_t tuples = piece.*kind.count; tuples > 0)
        whole.segments.push_back(
            {(piece.*kind.fields).arrays[k], tuples * static_cast<std::uint64_t>(like.components)});
    ForeignArray as{.name = like.name, .type = *like.type};
    // VTK's active vectors must have three components.
    as.active = like.name == first.scalars || (like.name == first.vectors && like.components == 3);
    as.ids = like.name == first.global_ids || like.name == first.pedigree_ids;
    if (of.grid.major < 2 && like.name == "vtkGhostLevels" && like.type == NumberType::uint8 && like.components == 1)
      as.name = "vtkGhostType", whole.has_ghost_levels = true;
    wholes.push_back(whole);
    decoded.push_back(std::make_shared<VtkXmlDecoded>());
    fields.push_back(hold_whole(of, std::move(whole), std::move(as), decoded.back()));
    bytes += fields.back().bytes();
  }
  tbb::parallel_for(std::size_t{0}, fields.size(), [&](std::size_t k) {
    tally(of, wholes[k], fields[k], bytes <= most_decoded ? decoded[k].get() : nullptr);
  });
  return fields;
}

}  // namespace tessera::io
