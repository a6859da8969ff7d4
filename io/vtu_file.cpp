#include "io/vtu_file.hpp"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "io/positional_file.hpp"
#include "io/vtk_xml_arrays.hpp"
#include "io/vtk_xml_grid.hpp"
#include "io/vtk_xml_numbers.hpp"
#include "io/vtu_cells.hpp"
#include "scene/error.hpp"

namespace tessera::io {
namespace {

using SharedFile = std::shared_ptr<const PositionalFile>;

/// What a field's or the points' numbers become: as they are, or the ghost levels of old files as bits.
enum class Becomes : std::uint8_t { same, ghost_bits };

/// An array of all pieces, one after the other.
struct WholeArray {
  std::vector<VtkXmlSegment> segments;
  int components = 1;
  Becomes becomes = Becomes::same;
};

void stream_whole(const PositionalFile& file, const WholeArray& array, const std::string& source, const ByteSink& use) {
  std::vector<std::byte> bits;
  for (const VtkXmlSegment& segment : array.segments)
    stream_numbers(file, segment, static_cast<std::size_t>(array.components), source,
                   [&](std::span<const std::byte> part) {
                     if (array.becomes == Becomes::same) return use(part);
                     bits.assign(part.begin(), part.end());
                     for (std::byte& level : bits) level = std::byte{level > std::byte{0}};
                     use(bits);
                   });
}

class VtuParts {
 public:
  VtuParts(SharedFile file, const VtkXmlGrid& grid, const std::string& source)
      : file_(std::move(file)), grid_(grid), source_(source), arrays_(std::make_shared<VtkXmlArrays>()) {}

  /// Whether all pieces that are not empty have the same arrays. VTK's reader takes those of the first piece, and
  /// leaves what others lack as memory happened to be.
  [[nodiscard]] bool pieces_agree() const {
    const VtkXmlFields& point_fields = first_fields(&VtkXmlPiece::point_fields, &VtkXmlPiece::points);
    const VtkXmlFields& cell_fields = first_fields(&VtkXmlPiece::cell_fields, &VtkXmlPiece::cells);
    for (const VtkXmlPiece& piece : grid_.pieces) {
      if (piece.points > 0 && !are_like(piece.point_fields.arrays, point_fields.arrays)) return false;
      if (piece.cells > 0 && !are_like(piece.cell_fields.arrays, cell_fields.arrays)) return false;
      if (piece.points > 0 && piece.coordinates.size() == 1 &&
          (piece.coordinates[0].type != points_.type || piece.coordinates[0].components != points_.components))
        return false;
    }
    return true;
  }

  /// The points' array, of the first piece that has some.
  void find_points() {
    for (std::size_t p = 0; p < grid_.pieces.size(); ++p) {
      const VtkXmlPiece& piece = grid_.pieces[p];
      if (piece.points == 0) continue;
      if (piece.coordinates.size() != 1 || !piece.coordinates[0].type)
        throw scene::bad_input(
            fmt::format("{}: piece {} of it has {} arrays of points, not one; the file is damaged, "
                        "export it again",
                        source_, p, piece.coordinates.size()));
      if (!points_.type) points_ = piece.coordinates[0];
    }
  }

  ForeignFile opened() {
    ForeignPart part;
    if (points_.type) part.points = points();
    add_cells(part);
    part.point_fields = fields(&VtkXmlPiece::point_fields, &VtkXmlPiece::points);
    part.cell_fields = fields(&VtkXmlPiece::cell_fields, &VtkXmlPiece::cells);
    ForeignFile opened;
    opened.source = source_;
    opened.arrays = arrays_;
    opened.contents.parts.push_back(std::move(part));
    opened.contents.block_names.emplace_back();
    return opened;
  }

 private:
  static bool are_like(const std::vector<VtkXmlArray>& a, const std::vector<VtkXmlArray>& b) {
    return std::ranges::equal(a, b, [](const VtkXmlArray& x, const VtkXmlArray& y) { return x.is_like(y); });
  }

  ForeignArray hold(WholeArray array, ForeignArray as) {
    as.components = array.components;
    std::uint64_t numbers = 0;
    for (const VtkXmlSegment& segment : array.segments) {
      require_numbers(*file_, segment, source_);
      numbers += segment.numbers;
    }
    as.tuples = numbers / static_cast<std::uint64_t>(array.components);
    return arrays_->hold(std::move(as), [file = file_, array = std::move(array), source = source_](
                                            const ByteSink& use) { stream_whole(*file, array, source, use); });
  }

  ForeignArray points() {
    WholeArray all{{}, points_.components};
    for (const VtkXmlPiece& piece : grid_.pieces)
      if (piece.points > 0)
        all.segments.push_back({piece.coordinates[0], piece.points * static_cast<std::uint64_t>(points_.components)});
    return hold(std::move(all), {.type = *points_.type});
  }

  void add_cells(ForeignPart& part) {
    VtuCells cells = read_vtu_cells(*file_, grid_, source_);
    part.connectivity = connectivity(cells);
    if (cells.are_tets) return;
    part.types = arrays_->hold_vector({.type = NumberType::uint8}, std::move(cells.types));
    part.offsets = arrays_->hold_vector({.type = NumberType::uint64}, std::move(cells.offsets));
    if (cells.faces.empty()) return;
    part.faces = arrays_->hold_vector({.type = NumberType::uint32}, std::move(cells.faces));
    part.face_locations = arrays_->hold_vector({.type = NumberType::int64}, std::move(cells.face_locations));
  }

  ForeignArray connectivity(VtuCells& cells) {
    ForeignArray as{.type = NumberType::uint32, .components = cells.are_tets ? 4 : 1};
    if (!cells.connectivity.empty()) return arrays_->hold_vector(std::move(as), std::move(cells.connectivity));
    struct Uses {
      VtkXmlSegment segment;
      std::uint64_t first_point;
    };
    std::vector<Uses> uses;
    std::uint64_t first_point = 0;
    for (std::size_t p = 0; p < grid_.pieces.size(); first_point += grid_.pieces[p++].points)
      if (cells.uses[p] > 0)
        uses.push_back({{topology_of(grid_, p, "connectivity", source_), cells.uses[p]}, first_point});
    as.tuples = cells.offsets.back() / static_cast<std::uint64_t>(as.components);
    return arrays_->hold(std::move(as), [file = file_, uses, source = source_](const ByteSink& use) {
      std::vector<std::uint32_t> narrow;
      for (const Uses& piece : uses)
        stream_whole_numbers(*file, piece.segment, 4, source, [&](std::span<const std::int64_t> points) {
          narrow.resize(points.size());
          for (std::size_t k = 0; k < points.size(); ++k) narrow[k] = point_number(points[k], piece.first_point);
          use(std::as_bytes(std::span(narrow)));
        });
    });
  }

  /// Of the first piece that is not empty.
  [[nodiscard]] const VtkXmlFields& first_fields(VtkXmlFields VtkXmlPiece::*kind,
                                                 std::uint64_t VtkXmlPiece::*count) const {
    const auto first = std::ranges::find_if(grid_.pieces, [&](const VtkXmlPiece& piece) { return piece.*count > 0; });
    return (first != grid_.pieces.end() ? *first : grid_.pieces.front()).*kind;
  }

  std::vector<ForeignArray> fields(VtkXmlFields VtkXmlPiece::*kind, std::uint64_t VtkXmlPiece::*count) {
    const VtkXmlFields& first = first_fields(kind, count);
    std::vector<ForeignArray> fields;
    std::vector<WholeArray> wholes;
    for (std::size_t k = 0; k < first.arrays.size(); ++k) {
      const VtkXmlArray& like = first.arrays[k];
      if (!like.type) continue;
      WholeArray all{{}, like.components};
      for (const VtkXmlPiece& piece : grid_.pieces)
        if (piece.*count > 0)
          all.segments.push_back({(piece.*kind).arrays[k], piece.*count * static_cast<std::uint64_t>(like.components)});
      ForeignArray as{.name = like.name, .type = *like.type};
      // Active vectors have three components to VTK.
      as.active = like.name == first.scalars || (like.name == first.vectors && like.components == 3);
      if (grid_.major < 2 && like.name == "vtkGhostLevels" && like.type == NumberType::uint8 && like.components == 1)
        as.name = "vtkGhostType", all.becomes = Becomes::ghost_bits;
      wholes.push_back(all);
      fields.push_back(hold(std::move(all), std::move(as)));
    }
    tbb::parallel_for(std::size_t{0}, fields.size(), [&](std::size_t k) { tally(wholes[k], fields[k]); });
    return fields;
  }

  void tally(const WholeArray& array, ForeignArray& field) const {
    std::array<double, 4096> some{};
    stream_whole(*file_, array, source_, [&](std::span<const std::byte> bytes) {
      const std::size_t tuples = bytes.size() / field.tuple_bytes();
      for (std::size_t first = 0; first < tuples; first += some.size()) {
        const std::span chunk(some.data(), std::min(some.size(), tuples - first));
        read_tuples(bytes, field.type, field.components, field.components == 1 ? 0 : magnitude, first, chunk);
        field.tally.add(chunk);
      }
    });
  }

  SharedFile file_;
  const VtkXmlGrid& grid_;
  const std::string& source_;
  std::shared_ptr<VtkXmlArrays> arrays_;
  VtkXmlArray points_;
};

}  // namespace

void require_vtk_xml_end(const std::filesystem::path& path) {
  const PositionalFile file(path);
  std::string end(std::min<std::uint64_t>(file.size(), 1024), '\0');
  file.read(file.size() - end.size(), reinterpret_cast<std::byte*>(end.data()), end.size());
  if (end.find("</VTKFile") == std::string::npos)
    throw scene::bad_input(
        fmt::format("{}: it does not end with </VTKFile>; the file is truncated or damaged, export "
                    "it again",
                    path.string()));
}

std::optional<ForeignFile> open_vtu(const std::filesystem::path& path) {
  const std::string source = path.string();
  require_vtk_xml_end(path);
  const auto file = std::make_shared<const PositionalFile>(path);
  const auto grid = read_vtk_xml_grid(*file, source);
  if (!grid || grid->element.name != "UnstructuredGrid") return std::nullopt;
  VtuParts parts(file, *grid, source);
  parts.find_points();
  if (!parts.pieces_agree()) return std::nullopt;
  return parts.opened();
}

}  // namespace tessera::io
