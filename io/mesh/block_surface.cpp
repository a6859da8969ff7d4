// SPDX-License-Identifier: BSD-3-Clause
#include "io/mesh/block_surface.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <optional>

#include "cells/cell_split.hpp"
#include "cells/field_choice.hpp"
#include "cells/polygon_triangles.hpp"
#include "io/text/clean_errors.hpp"
#include "scene/error.hpp"
#include "tessera/cell_type.hpp"

namespace tessera::io {
namespace {

/// Returns the corners of a two-dimensional cell in order around the cell; empty for other cells.
std::vector<std::uint32_t> rim_of(std::uint8_t type, std::span<const std::uint32_t> points) {
  std::size_t corners = 0;
  switch (CellType{type}) {
    case CellType::triangle:
    case CellType::quadratic_triangle:
    case CellType::biquadratic_triangle:
    case CellType::lagrange_triangle:
      corners = 3;
      break;
    case CellType::pixel:
      if (points.size() >= 4) return {points[0], points[1], points[3], points[2]};
      break;
    case CellType::quad:
    case CellType::quadratic_quad:
    case CellType::biquadratic_quad:
    case CellType::quadratic_linear_quad:
    case CellType::lagrange_quadrilateral:
      corners = 4;
      break;
    case CellType::polygon:
      corners = points.size();
      break;
    case CellType::quadratic_polygon:  // the corners, then the same number of mid-edge nodes
      corners = points.size() / 2;
      break;
    default:
      break;
  }
  if (corners < 3 || points.size() < corners) return {};
  return {points.begin(), points.begin() + static_cast<std::ptrdiff_t>(corners)};
}

class Faces {
 public:
  Faces(const cells::FieldChoice* choice, BlockFaces& to) : choice_(choice), to_(to) {}

  void add(const cells::CellBlock& block, const std::string& source) {
    if (!block.tets.empty()) to_.has_volume = true;
    read_values(block);
    for (std::size_t c = 0; c < block.types.size(); ++c) {
      const auto points =
          std::span(block.connectivity).subspan(block.offsets[c], block.offsets[c + 1] - block.offsets[c]);
      if (block.types[c] == vtk_number(CellType::triangle_strip)) {
        for (std::size_t k = 0; k + 2 < points.size(); ++k)
          add_face(block, c, std::array{points[k + k % 2], points[k + 1 - k % 2], points[k + 2]}, source);
        continue;
      }
      const std::vector<std::uint32_t> rim = rim_of(block.types[c], points);
      if (!rim.empty())
        add_face(block, c, rim, source);
      else if (cells::cell_shape(block.types[c]).kind != cells::CellKind::not_volumetric)
        to_.has_volume = true;
    }
  }

 private:
  void read_values(const cells::CellBlock& block) {
    values_.clear();
    if (choice_ == nullptr) return;
    const cells::BlockField* const field = cells::find_field(block, choice_->name, choice_->association);
    const bool point = choice_->association == scene::Association::point;
    values_.assign(point ? block.positions.size() : block.cell_count(), 0);
    if (field != nullptr && field->tuples == values_.size())
      field->read(choice_->component, 0, values_);
    else
      has_values_ = false;
  }

  /// Adds a face with its own points, because a shared point would have several values of cell data.
  void add_face(const cells::CellBlock& block, std::size_t cell, std::span<const std::uint32_t> rim,
                const std::string& source) {
    triangles_.clear();
    cutter_.cut(rim, block.positions, triangles_);
    for (const auto& triangle : triangles_) {
      const auto first = static_cast<std::uint32_t>(to_.mesh.points.size());
      for (const std::uint32_t v : triangle) {
        const glm::dvec3& p = block.positions[v];
        if (!(std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z)))
          throw scene::bad_input(fmt::format("{}: point {} of its faces is not finite; correct it", source, v));
        to_.mesh.points.push_back(p);
        if (choice_ == nullptr) continue;
        const double value = values_[choice_->association == scene::Association::point ? v : cell];
        to_.mesh.values.push_back(value);
        if (!std::isfinite(value)) has_values_ = false;
      }
      to_.mesh.triangles.push_back({first, first + 1, first + 2});
    }
    if (!has_values_) to_.mesh.values.clear(), choice_ = nullptr;
  }

  const cells::FieldChoice* choice_;
  BlockFaces& to_;
  bool has_values_ = true;
  std::vector<double> values_;
  std::vector<std::array<std::uint32_t, 3>> triangles_;
  cells::PolygonTriangles cutter_;
};

/// The requested field, if the blocks have it.
std::optional<cells::FieldChoice> field_of(std::span<const cells::CellBlock> blocks, const std::string& requested,
                                           const std::string& source) {
  if (requested.empty()) return std::nullopt;
  const std::vector<cells::FieldTally> tallies = cells::tally_fields(blocks);
  try {
    return cells::choose_field(requested, cells::summarize_fields(std::span(&tallies, 1)), source);
  } catch (const scene::Error&) {
    return std::nullopt;
  }
}

}  // namespace

BlockFaces read_block_faces(std::span<const InputFile> files, const ReadOptions& read) {
  const MeshOptions options{read, true};
  const std::string& source = files.front().name;
  return with_clean_errors(source, [&] {
    std::vector<cells::CellBlock> blocks;
    for (const InputFile& file : files) {
      cells::MeshBlocks mesh = read_mesh_blocks(file, options);
      std::move(mesh.blocks.begin(), mesh.blocks.end(), std::back_inserter(blocks));
    }
    const std::optional<cells::FieldChoice> choice = field_of(blocks, options.field, source);
    BlockFaces result;
    Faces faces(choice ? &*choice : nullptr, result);
    for (const cells::CellBlock& block : blocks) faces.add(block, source);
    return result;
  });
}

}  // namespace tessera::io
