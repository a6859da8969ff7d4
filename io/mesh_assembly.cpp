#include "io/mesh_assembly.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <numeric>

#include "io/cell_split.hpp"
#include "io/field_choice.hpp"
#include "scene/error.hpp"

namespace tessera::io {
namespace {

using scene::Association;
using scene::Tet;

// vtkDataSetAttributes.h: CellGhostTypes and PointGhostTypes.
constexpr std::uint8_t duplicate_cell = 1, refined_cell = 8, hidden_cell = 32, hidden_point = 2;

bool finite(const glm::dvec3& p) { return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z); }

/// Turns blocks into one mesh, a block at a time.
class Assembly {
 public:
  Assembly(AssembledBlocks& result, std::span<const FieldSummary> fields, const FieldChoice& choice,
           const std::string& source)
      : notes_(result.notes),
        mesh_(result.mesh),
        counts_(result.counts),
        fields_(fields),
        choice_(choice),
        source_(source) {
    for (int type = 0; type < 256; ++type) shapes_[type] = cell_shape(static_cast<std::uint8_t>(type));
  }

  void reserve(std::size_t points, std::size_t tets) {
    if (points > std::numeric_limits<std::uint32_t>::max())
      throw scene::bad_input(
          fmt::format("{}: {} points; one process takes at most 2^32 - 1, convert to a .pvtu of "
                      "pieces",
                      source_, points));
    mesh_.positions.reserve(points);
    mesh_.tets.reserve(tets);
  }

  void add(CellBlock& block) {
    const std::size_t first_point = mesh_.positions.size();
    if (first_point == 0) {
      mesh_.positions = std::move(block.positions);
    } else {
      mesh_.positions.insert(mesh_.positions.end(), block.positions.begin(), block.positions.end());
      block.positions = {};
    }
    for (std::size_t v = first_point; v < mesh_.positions.size(); ++v)
      mesh_.positions[v] += 0.0;  // -0 becomes 0: coincident points get the same bits
    counts_.points_read = mesh_.positions.size();
    points_ = std::span(mesh_.positions).subspan(first_point);
    first_point_ = static_cast<std::uint32_t>(first_point);
    read_values(block);

    const std::size_t cells = block.cell_count();
    for (std::size_t c = 0; c < cells; ++c) add_cell(block, c);
    counts_.cells_read += cells;
    block = {};
  }

  void finish() {
    counts_.tets_made = mesh_.tets.size();
    if (choice_.association == Association::point) mesh_.scalars = std::move(values_);
    mesh_.association = choice_.association;
    mesh_.field_name = choice_.label;
    std::vector<bool> used(mesh_.positions.size());
    for (const Tet& tet : mesh_.tets)
      for (const std::uint32_t v : tet) used[v] = true;
    counts_.points_unused = static_cast<std::uint64_t>(std::count(used.begin(), used.end(), false));
  }

 private:
  /// Scalars of the block's points (appended to those before) or cells; NaN where the block lacks the field.
  void read_values(const CellBlock& block) {
    const bool point = choice_.association == Association::point;
    const std::size_t n = point ? points_.size() : block.cell_count();
    if (!point) values_.clear();
    const std::size_t first = values_.size();
    if (choice_.name.empty()) {
      values_.resize(first + n, 1.0);
      return;
    }
    values_.resize(first + n, std::numeric_limits<double>::quiet_NaN());
    const BlockField* field = find_field(block, choice_.name, choice_.association);
    const auto same = [&](const FieldSummary& s) {
      return s.name == choice_.name && s.association == choice_.association;
    };
    const auto summary = std::find_if(fields_.begin(), fields_.end(), same);
    if (!field || summary == fields_.end() || field->components != summary->components) {
      if (block.cell_count() > 0 && !block.source.empty())
        throw scene::bad_input(fmt::format(
            "{}: it has no {} field '{}' of {} as other pieces have; write all pieces "
            "with the same fields",
            block.source, point ? "point" : "cell", choice_.name,
            summary == fields_.end() || summary->components == 1 ? "one component"
                                                                 : fmt::format("{} components", summary->components)));
      if (block.cell_count() > 0)
        notes_.push_back(
            fmt::format("block '{}' lacks the field '{}': its cells are blanked", block.name, choice_.name));
      return;
    }
    field->read(choice_.component, 0, std::span(values_).subspan(first, n));
  }

  void add_cell(const CellBlock& block, std::size_t c) {
    const bool all_tets = block.types.empty();
    const CellShape& shape = shapes_[all_tets ? 10 : block.types[c]];
    const std::size_t begin = all_tets ? 4 * c : block.offsets[c];
    const std::size_t nodes = all_tets ? 4 : block.offsets[c + 1] - begin;
    if (shape.kind == CellKind::not_volumetric) {
      ++counts_.cells_not_volumetric;
      return;
    }
    if (shape.kind == CellKind::unsupported)
      throw scene::bad_input(
          fmt::format("{}: {} is a {}, which is not rendered; split such cells into tetrahedra "
                      "first (ParaView: Tetrahedralize)",
                      source_of(block), place(block, c), cell_type_name(block.types[c])));
    if (shape.nodes ? nodes != static_cast<std::size_t>(shape.nodes) : nodes < static_cast<std::size_t>(shape.corners))
      throw scene::bad_input(fmt::format(
          "{}: {} is a {} with {} nodes, it has to have {}; mend the cell types", source_of(block), place(block, c),
          cell_type_name(all_tets ? 10 : block.types[c]), nodes, shape.nodes ? shape.nodes : shape.corners));
    const std::uint8_t ghost = block.cell_ghost.empty() ? 0 : block.cell_ghost[c];
    if (ghost & duplicate_cell) {
      ++counts_.cells_ghost;
      return;
    }
    const std::span<const std::uint32_t> corner(block.connectivity.data() + begin,
                                                static_cast<std::size_t>(shape.corners));
    if ((ghost & (hidden_cell | refined_cell)) || hides_a_point(block, corner)) {
      ++counts_.cells_hidden;
      return;
    }
    if (!is_finite(corner, c)) {
      ++counts_.cells_nan;
      return;
    }
    if (shape.higher_order) ++counts_.cells_quadratic;
    cell_tets_.clear();
    split_cell(shape.kind, corner, points_, cell_tets_);
    keep_tets(c);
  }

  void keep_tets(std::size_t c) {
    const std::uint64_t cell = counts_.cells_read + c;
    double positive = 0, negative = 0;
    for (const Tet& tet : cell_tets_) {
      const glm::dvec3 a = points_[tet[0]], b = points_[tet[1]], p = points_[tet[2]], q = points_[tet[3]];
      // A tet with two corners at one place is flat, two of its faces are the same triangle and the other two have no
      // area: leaving it out puts its two neighbours face to face.
      if (a == b || a == p || a == q || b == p || b == q || p == q) {
        ++counts_.tets_collapsed;
        continue;
      }
      const double volume = glm::dot(glm::cross(b - a, p - a), q - a);
      (volume > 0 ? positive : negative) += std::abs(volume);
      push(tet, cell);
    }
    if (positive + negative == 0) ++counts_.cells_zero_volume;
    if (std::min(positive, negative) > 1e-9 * (positive + negative)) ++counts_.cells_tangled;
  }

  void push(const Tet& tet, std::uint64_t cell) {
    if (mesh_.original_cell.empty() && cell != mesh_.tets.size()) {  // from here on, tet and cell numbers differ
      mesh_.original_cell.reserve(mesh_.tets.capacity());
      mesh_.original_cell.resize(mesh_.tets.size());
      std::iota(mesh_.original_cell.begin(), mesh_.original_cell.end(), std::uint64_t{0});
      numbered_ = true;
    }
    if (numbered_) mesh_.original_cell.push_back(cell);
    if (choice_.association == Association::cell) mesh_.scalars.push_back(values_[cell - counts_.cells_read]);
    mesh_.tets.push_back({tet[0] + first_point_, tet[1] + first_point_, tet[2] + first_point_, tet[3] + first_point_});
  }

  static bool hides_a_point(const CellBlock& block, std::span<const std::uint32_t> corner) {
    return !block.point_ghost.empty() && std::any_of(corner.begin(), corner.end(), [&](std::uint32_t v) {
      return block.point_ghost[v] & hidden_point;
    });
  }

  bool is_finite(std::span<const std::uint32_t> corner, std::size_t c) const {
    const bool point = choice_.association == Association::point;
    if (!point && !std::isfinite(values_[c])) return false;
    return std::all_of(corner.begin(), corner.end(), [&](std::uint32_t v) {
      return finite(points_[v]) && (!point || std::isfinite(values_[first_point_ + v]));
    });
  }

  static std::string place(const CellBlock& block, std::size_t c) {
    return block.name.empty() ? fmt::format("cell {}", c) : fmt::format("block '{}', cell {}", block.name, c);
  }

  [[nodiscard]] const std::string& source_of(const CellBlock& block) const {
    return block.source.empty() ? source_ : block.source;
  }

  std::vector<std::string>& notes_;
  scene::TetMesh& mesh_;
  MeshCounts& counts_;
  std::span<const FieldSummary> fields_;
  const FieldChoice& choice_;
  const std::string& source_;
  std::array<CellShape, 256> shapes_;
  std::span<const glm::dvec3> points_;  ///< of the block at hand
  std::uint32_t first_point_ = 0;
  std::vector<double> values_;  ///< of all points so far, or of the block's cells
  std::vector<Tet> cell_tets_;
  bool numbered_ = false;
};

}  // namespace

AssembledBlocks assemble_blocks(std::vector<CellBlock> blocks, std::span<const FieldSummary> fields,
                                const FieldChoice& choice, const std::string& source) {
  AssembledBlocks result;
  Assembly assembly(result, fields, choice, source);
  std::size_t points = 0, tets = 0;
  for (const CellBlock& block : blocks) {
    points += block.positions.size();
    tets += block.types.empty() ? block.cell_count() : 0;
  }
  assembly.reserve(blocks.size() > 1 ? points : 0, tets);
  for (CellBlock& block : blocks) assembly.add(block);
  assembly.finish();
  return result;
}

std::vector<std::string> notes_on_cells(const MeshCounts& n, const std::string& source) {
  if (n.cells_read == 0)
    throw scene::bad_input(
        fmt::format("{}: it holds no cells, nothing is left to render; check how it was written", source));
  if (n.tets_made == 0)
    throw scene::bad_input(fmt::format(
        "{}: nothing is left to render: of {} cells {} are no volumes, {} ghosts, {} hidden, {} hold NaN or infinite "
        "numbers, {} are collapsed to a point or face; give a mesh of volume cells or choose another field",
        source, n.cells_read, n.cells_not_volumetric, n.cells_ghost, n.cells_hidden, n.cells_nan, n.cells_zero_volume));
  std::vector<std::string> notes;
  if (n.cells_quadratic > 0)
    notes.push_back(
        fmt::format("{} higher-order cells are rendered as linear ones by their corner nodes", n.cells_quadratic));
  if (n.cells_tangled > 0)
    notes.push_back(fmt::format("{} cells are so warped that their tets overlap", n.cells_tangled));
  return notes;
}

MeshFile assemble_mesh(std::vector<CellBlock> blocks, const MeshOptions& options, const std::string& source) {
  MeshFile file;
  const std::vector<FieldTally> tallies = tally_fields(blocks);
  file.fields = summarize_fields(std::span(&tallies, 1));
  const FieldChoice choice = choose_field(options.field, file.fields, source);
  file.notes = choice.notes;

  AssembledBlocks assembled = assemble_blocks(std::move(blocks), file.fields, choice, source);
  file.mesh = std::move(assembled.mesh);
  file.counts = assembled.counts;
  const auto add = [&](const std::vector<std::string>& notes) {
    file.notes.insert(file.notes.end(), notes.begin(), notes.end());
  };
  add(assembled.notes);
  add(notes_on_cells(file.counts, source));
  if (options.smooth) {
    if (choice.association == Association::cell)
      smooth_to_points(file.mesh);
    else
      file.notes.emplace_back("smoothing has no effect on point data");
  }
  return file;
}

}  // namespace tessera::io
