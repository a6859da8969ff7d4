// SPDX-License-Identifier: BSD-3-Clause
// Regular and rectilinear grids held by a helper.
#include "io/foreign/foreign_grids.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "cells/field_choice.hpp"
#include "cells/ghost_bits.hpp"
#include "io/files/input_file.hpp"
#include "io/foreign/client/foreign_geometry.hpp"
#include "io/volume/brick_file.hpp"
#include "io/volume/volume_formats.hpp"

namespace tessera::io {
namespace {

using scene::Association;
using scene::SampleType;

AxisCoordinates coordinates_of(const ForeignFile& file, const ForeignArray& array, std::size_t axis,
                               std::int64_t points) {
  if (static_cast<std::int64_t>(array.tuples) != points || array.components != 1)
    throw damaged(file.source,
                  fmt::format("it has {} coordinates along {}, but {} points", array.tuples, "xyz"[axis], points));
  AxisCoordinates c{array.type, std::vector<double>(array.tuples)};
  read_tuples(file.arrays->copy(array, file.source), array.type, 1, 0, 0, c.values);
  return c;
}

scene::GridGeometry geometry_of(const ForeignFile& file, const ForeignPart& part) {
  scene::GridGeometry g;
  for (std::size_t a = 0; a < 3; ++a) g.points[a] = part.extent[2 * a + 1] - part.extent[2 * a] + 1;
  if (part.kind == ForeignPart::Kind::image) {
    set_image_geometry(part, g);
  } else if (part.kind == ForeignPart::Kind::rectilinear && part.coordinates.size() == 3) {
    g.origin = {part.origin[0], part.origin[1], part.origin[2]};
    if (std::any_of(part.direction.begin(), part.direction.end(), [](double x) { return x != 0; }))
      for (std::size_t k = 0; k < 9; ++k)
        g.direction[static_cast<int>(k % 3)][static_cast<int>(k / 3)] = part.direction[k];
    std::array<AxisCoordinates, 3> axes;
    for (std::size_t a = 0; a < 3; ++a) axes[a] = coordinates_of(file, part.coordinates[a], a, g.points[a]);
    set_rectilinear_geometry(std::move(axes), g);
  } else {
    throw scene::bad_input(fmt::format("{}: it holds no regular or rectilinear grid; give a volume", file.source));
  }
  return g;
}

/// Indices of the samples (points, or cells for cell data) that the file hides by vtkGhostType.
std::vector<std::size_t> hidden_samples(const ForeignFile& file, const ForeignPart& part, Association association,
                                        const scene::GridGeometry& g, std::vector<std::string>& notes) {
  std::vector<std::size_t> hidden;
  const bool point = association == Association::point;
  const auto bits_of = [&](const std::vector<ForeignArray>& fields) {
    const auto ghost =
        std::find_if(fields.begin(), fields.end(), [](const ForeignArray& a) { return a.name == "vtkGhostType"; });
    return ghost == fields.end() ? std::vector<std::uint8_t>() : ghost_bits(file, fields, ghost->tuples);
  };
  const auto samples = static_cast<std::size_t>(g.all_samples().count());
  const std::vector<std::uint8_t> bits = bits_of(point ? part.point_fields : part.cell_fields);
  for (std::size_t k = 0; k < std::min(bits.size(), samples); ++k)
    if ((bits[k] & (point ? cells::hidden_point : cells::hidden_cell)) != 0) hidden.push_back(k);
  if (point) {
    if (std::ranges::any_of(bits_of(part.cell_fields), [](std::uint8_t b) { return (b & cells::hidden_cell) != 0; }))
      notes.emplace_back("hidden cells are shown, because hiding cells affects only cell data");
  }
  return hidden;
}

/// Stores the samples of one component in memory or, if requested, in a scratch file.
void set_source(const ForeignFile& file, const ForeignPart& part, const cells::FieldChoice& choice,
                const cells::BlockField& field, const VolumeOptions& options, scene::Grid grid, VolumeFile& result) {
  const auto& arrays = choice.association == Association::point ? part.point_fields : part.cell_fields;
  const auto array =
      std::find_if(arrays.begin(), arrays.end(), [&](const ForeignArray& a) { return a.name == choice.name; });
  const auto hidden = hidden_samples(file, part, choice.association, grid.geometry, result.notes);
  const std::optional<SampleType> plain = array == arrays.end() ? std::nullopt : scene::sample_type_of(array->type);
  const SampleType type = plain.value_or(SampleType::float64);
  // float32 represents numbers of up to 16 bits exactly, and is precise enough for magnitudes of floats.
  const bool narrow = scene::size_of(type) < 4 || type == SampleType::float32;
  if (plain && hidden.empty()) {
    grid.type = choice.component != cells::magnitude ? type : narrow ? SampleType::float32 : SampleType::float64;
    const scene::ComponentChoice of_tuple{field.components,
                                          choice.component == cells::magnitude ? -1 : choice.component, type};
    const auto tuples = [&](const system::ByteSink& use) { file.arrays->stream(*array, file.source, use); };
    if (unpacked_to_scratch({grid, of_tuple, false, tuples}, options, file.source, result)) return;
    auto owner = std::make_shared<const std::vector<std::byte>>(file.arrays->copy(*array, file.source));
    const std::span<const std::byte> payload = *owner;
    result.source =
        std::make_unique<scene::MemorySource>(std::move(grid), payload, std::move(owner), file.source, of_tuple);
    return;
  }
  std::vector<double> values(field.tuples);
  field.read(choice.component, 0, values);
  for (const std::size_t k : hidden) values[k] = std::numeric_limits<double>::quiet_NaN();
  if (!hidden.empty()) result.notes.push_back(fmt::format("{} hidden samples are blank", hidden.size()));
  if (narrow)
    result.source =
        scene::MemorySource::of(std::move(grid), std::vector<float>(values.begin(), values.end()), file.source);
  else
    result.source = scene::MemorySource::of(std::move(grid), std::move(values), file.source);
}

}  // namespace

VolumeFile grid_of(const ForeignFile& opened, const VolumeOptions& options) {
  if (opened.contents.parts.size() != 1)
    throw scene::bad_input(
        fmt::format("{}: it contains {} grids, but a volume must have one; give a file with a single grid",
                    opened.source, opened.contents.parts.size()));
  const std::string& source = opened.source;
  const ForeignPart& part = opened.contents.parts.front();
  VolumeFile result;
  result.notes = opened.contents.notes;
  result.time_step = opened.contents.time_step;
  result.xy_in_degrees = opened.contents.xy_in_degrees;
  scene::Grid grid;
  grid.geometry = geometry_of(opened, part);
  result.format = opened.contents.format;
  if (result.format.starts_with("DICOM")) result.body_axes = BodyAxes::lps;
  if (result.format.starts_with("MINC")) result.body_axes = BodyAxes::ras;
  result.tags = {.modality = opened.contents.modality,
                 .unit = opened.contents.unit,
                 .length_unit = result.body_axes == BodyAxes::none ? "" : "mm",
                 .labels = opened.contents.labels};

  cells::CellBlock block;  // only the fields of the block are used
  std::size_t points = 1, cells = 1;
  for (const std::int64_t n : grid.geometry.points) {
    points *= static_cast<std::size_t>(std::max<std::int64_t>(n, 0));
    cells *= static_cast<std::size_t>(std::max<std::int64_t>(n - 1, 1));
  }
  add_foreign_fields(opened, part, Association::point, points, block, source);
  add_foreign_fields(opened, part, Association::cell, cells, block, source);
  if (block.fields.empty()) throw scene::bad_input(fmt::format("{}: it has no field; write it with a field", source));
  const std::vector<std::vector<cells::FieldTally>> tallies = {cells::tally_fields(std::span(&block, 1))};
  result.fields = cells::summarize_fields(tallies);
  const cells::FieldChoice choice = cells::choose_field(options.field, result.fields, source);
  result.notes.insert(result.notes.end(), choice.notes.begin(), choice.notes.end());
  for (const cells::FieldSummary& listed : result.fields)
    if (listed.name == choice.name && listed.association == choice.association && cells::look_like_colors(listed))
      cells::refuse_colors(choice, listed, options.field, source);
  const cells::BlockField* field = cells::find_field(block, choice.name, choice.association);
  if (!field) throw scene::bad_input(fmt::format("{}: none of its fields can be shown; name one with `field`", source));
  grid.geometry.association = choice.association;
  grid.field_name = choice.label;
  scene::validate(grid, source);  // before memory for samples is allocated, which a flat grid does not have
  set_source(opened, part, choice, *field, options, std::move(grid), result);
  return result;
}

}  // namespace tessera::io
