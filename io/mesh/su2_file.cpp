// SPDX-License-Identifier: BSD-3-Clause
#include "io/mesh/su2_file.hpp"

#include <fmt/format.h>

#include <limits>

#include "io/files/whole_file.hpp"
#include "io/mesh/mesh_formats.hpp"
#include "io/text/scanner.hpp"
#include "scene/error.hpp"
#include "tessera/cell_type.hpp"

namespace tessera::io {
namespace {

/// Number of points of a VTK cell type that SU2 uses; 0 for others.
std::size_t nodes_of(std::uint64_t type) {
  switch (type) {
    case vtk_number(CellType::line):
      return 2;
    case vtk_number(CellType::triangle):
      return 3;
    case vtk_number(CellType::quad):
    case vtk_number(CellType::tetra):
      return 4;
    case vtk_number(CellType::hexahedron):
      return 8;
    case vtk_number(CellType::wedge):
      return 6;
    case vtk_number(CellType::pyramid):
      return 5;
    default:
      return 0;
  }
}

/// The non-empty lines of a text. Commas count as blanks; % begins a comment.
class Lines {
 public:
  Lines(std::string_view text, const std::string& source) : scanner_(text, source, " \t\r,", '%') {}

  bool next() { return scanner_.next_line(); }

  void need_next(const char* what, std::size_t k, std::size_t count) {
    if (!next()) fail(fmt::format("the file ends at {} {} of {}; it is truncated, write it again", what, k, count));
  }

  /// Returns the word before '=' on this line; empty if there is none. number() then reads the text after it.
  std::string_view key() { return scanner_.word_before('='); }

  template <class T>
  T number(const char* what) {
    T value{};
    const Scanned found = scanner_.number(value);
    if (found == Scanned::nothing) fail(fmt::format("{} is missing; write the file again", what));
    if (found == Scanned::other_word)
      fail(fmt::format("'{}' is not a {}; correct it", scanner_.word().substr(0, 20), what));
    // 1e999 becomes NaN: a cell with this number is blanked.
    if (found == Scanned::out_of_range && std::is_integral_v<T>) fail(fmt::format("{} is too large; correct it", what));
    return value;
  }

  /// Reads a count of lines that take at least `least` bytes each.
  std::size_t count(const char* what, std::size_t least) {
    const auto n = number<std::uint64_t>(what);
    if (n > scanner_.rest().size() / least + 1)
      fail(
          fmt::format("{} is {}, more than a file of this size can contain; it is truncated, write it again", what, n));
    return static_cast<std::size_t>(n);
  }

  [[noreturn]] void fail(const std::string& what) const { scanner_.fail(what); }

 private:
  TextScanner scanner_;
};

/// A zone that is being parsed. Its points may follow the cells that use them.
struct Zone {
  cells::CellBlock block;
  bool has_cells = false, has_points = false;
};

void read_cells(Lines& lines, Zone& zone) {
  if (zone.has_cells) lines.fail("NELEM is given twice in one zone; correct it");
  zone.has_cells = true;
  constexpr std::size_t least = 9;  // the shortest cell is a triangle: "5 0 1 2" and a line end
  const std::size_t count = lines.count("NELEM", least - 1);
  cells::CellBlock& block = zone.block;
  block.types.reserve(count);
  block.offsets.reserve(count + 1);
  block.offsets.push_back(0);
  for (std::size_t c = 0; c < count; ++c) {
    lines.need_next("cell", c, count);
    const auto type = lines.number<std::uint64_t>("cell type");
    const std::size_t nodes = nodes_of(type);
    if (nodes == 0 && nodes_of(type % 100) > 0)
      lines.fail(
          fmt::format("{} is a cell of order {}, which is not supported; have SU2 write .vtu", type, type / 100 + 1));
    if (nodes == 0) lines.fail(fmt::format("{} is not a cell type of SU2 (3 5 9 10 12 13 14); correct it", type));
    for (std::size_t k = 0; k < nodes; ++k) {
      const auto point = lines.number<std::uint64_t>("point number");
      if (point >= std::numeric_limits<std::uint32_t>::max()) lines.fail("a point number is too large; correct it");
      block.connectivity.push_back(static_cast<std::uint32_t>(point));
    }
    block.types.push_back(static_cast<std::uint8_t>(type));
    block.offsets.push_back(block.connectivity.size());
  }
}

void read_points(Lines& lines, Zone& zone) {
  if (zone.has_points) lines.fail("NPOIN is given twice in one zone; correct it");
  zone.has_points = true;
  constexpr std::size_t least = 6;  // shortest point: "0 0 0" and a line end
  const std::size_t count = lines.count("NPOIN", least);
  zone.block.positions.reserve(count);
  for (std::size_t v = 0; v < count; ++v) {
    lines.need_next("point", v, count);
    const auto x = lines.number<double>("coordinate"), y = lines.number<double>("coordinate"),
               z = lines.number<double>("coordinate");
    zone.block.positions.emplace_back(x, y, z);
  }
}

/// Throws unless a zone is complete and its cells use only points of the zone.
void check(const Zone& zone, const std::string& source) {
  const std::string where = zone.block.name.empty() ? source : fmt::format("{}: {}", source, zone.block.name);
  if (!zone.has_cells || !zone.has_points)
    throw scene::bad_input(
        fmt::format("{}: there is no {}; it is truncated, write it again", where, zone.has_cells ? "NPOIN" : "NELEM"));
  const std::size_t points = zone.block.positions.size();
  for (std::size_t c = 0; c < zone.block.types.size(); ++c)
    for (std::uint64_t k = zone.block.offsets[c]; k < zone.block.offsets[c + 1]; ++k)
      if (zone.block.connectivity[k] >= points)
        throw scene::bad_input(
            fmt::format("{}: cell {} uses point {}, but the file has only {} points; points count from 0, correct it",
                        where, c, zone.block.connectivity[k], points));
}

}  // namespace

std::vector<cells::CellBlock> parse_su2(std::string_view text, const std::string& source) {
  Lines lines(text, source);
  std::vector<Zone> zones(1);
  bool has_zones = false;
  while (lines.next()) {
    const std::string_view key = lines.key();
    if (key == "NDIME") {
      if (const auto dimensions = lines.number<std::uint64_t>("NDIME"); dimensions != 3)
        lines.fail(fmt::format("NDIME is {}: the mesh is not a volume; give one of 3 dimensions", dimensions));
    } else if (key == "IZONE") {
      // The name of the first zone precedes its counts.
      if (zones.back().has_cells || zones.back().has_points) zones.emplace_back();
      zones.back().block.name = fmt::format("zone {}", lines.number<std::uint64_t>("IZONE"));
      has_zones = true;
    } else if (key == "NELEM") {
      read_cells(lines, zones.back());
    } else if (key == "NPOIN") {
      read_points(lines, zones.back());
    }
  }
  std::vector<cells::CellBlock> blocks;
  for (Zone& zone : zones) {
    check(zone, source);
    if (!has_zones) zone.block.name.clear();
    blocks.push_back(std::move(zone.block));
  }
  return blocks;
}

cells::MeshBlocks read_su2(const InputFile& file, const MeshOptions& /*options*/) {
  return {parse_su2(WholeFile(file.path).text(), file.name), {}, "SU2"};
}

}  // namespace tessera::io
