// SPDX-License-Identifier: BSD-3-Clause
#include "io/mesh/medit_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <utility>

#include "cells/block_groups.hpp"
#include "io/files/whole_file.hpp"
#include "io/mesh/mesh_formats.hpp"
#include "io/text/clean_errors.hpp"
#include "io/text/scanner.hpp"
#include "scene/byte_order.hpp"
#include "scene/error.hpp"
#include "tessera/cell_type.hpp"

namespace tessera::io {
namespace {

constexpr std::int32_t code_dimension = 3, code_vertices = 4, code_end = 54, last_known_code = 250;

/// A keyword for cells, and the type of these cells.
struct MeditCells {
  std::int32_t code;
  std::string_view word;
  CellType type;
  std::size_t nodes;
};
constexpr std::array<MeditCells, 5> medit_cells = {{{8, "Tetrahedra", CellType::tetra, 4},
                                                    {9, "Prisms", CellType::wedge, 6},
                                                    {10, "Hexahedra", CellType::hexahedron, 8},
                                                    {49, "Pyramids", CellType::pyramid, 5},
                                                    {30, "TetrahedraP2", CellType::quadratic_tetra, 10}}};

/// Keywords of volume cells and node orders that are not supported.
constexpr std::array<std::pair<std::int32_t, std::string_view>, 14> unread_cells = {{{33, "hexahedra of order 2"},
                                                                                     {46, "polyhedra"},
                                                                                     {86, "prisms of order 2"},
                                                                                     {87, "pyramids of order 2"},
                                                                                     {96, "tetrahedra of order 3"},
                                                                                     {97, "tetrahedra of order 4"},
                                                                                     {98, "hexahedra of order 3"},
                                                                                     {99, "hexahedra of order 4"},
                                                                                     {100, "pyramids of order 3"},
                                                                                     {101, "pyramids of order 4"},
                                                                                     {102, "prisms of order 3"},
                                                                                     {103, "prisms of order 4"},
                                                                                     {133, "an order of nodes"},
                                                                                     {207, "polyhedra"}}};

/// Divides the cells into blocks after checking that their points exist.
std::vector<cells::CellBlock> checked_blocks(const cells::CellBlock& block, const std::vector<std::int64_t>& references,
                                             const std::string& source) {
  if (block.types.empty())
    throw scene::bad_input(fmt::format(
        "{}: it holds no cells of volume; give a mesh of tetrahedra, hexahedra, prisms or pyramids", source));
  for (const std::uint32_t node : block.connectivity)
    if (node >= block.positions.size())
      throw scene::bad_input(
          fmt::format("{}: a cell uses point {}, but the file has only {} points; the file is damaged, export it again",
                      source, std::uint64_t{node} + 1, block.positions.size()));
  return cells::blocks_by_number(block, references, "reference", "Reference");
}

void require_space(std::int64_t dimension, const std::string& source) {
  if (dimension != 3)
    throw scene::bad_input(
        fmt::format("{}: it has {} dimensions, but a volume has three; give a volume", source, dimension));
}

class MeditBinary {
 public:
  MeditBinary(std::span<const std::byte> bytes, const std::string& source) : bytes_(bytes), source_(source) {
    is_swapped_ = read<std::int32_t>("one") != 1;
    version_ = read<std::int32_t>("version");
    block_.offsets.push_back(0);
  }

  std::vector<cells::CellBlock> blocks() {
    while (at_ < bytes_.size()) {
      const std::size_t begin = at_;
      const auto code = read<std::int32_t>("keyword");
      const std::int64_t next = version_ >= 3 ? read<std::int64_t>("place") : read<std::int32_t>("place");
      if (code < 1 || code > last_known_code) fail(begin, fmt::format("it has an unknown keyword {}", code));
      read_keyword(code, begin);
      if (next == 0 || code == code_end) break;
      if (next < 0 || static_cast<std::uint64_t>(next) <= begin || static_cast<std::uint64_t>(next) > bytes_.size())
        fail(begin, fmt::format("the next keyword is at byte {} of {}", next, bytes_.size()));
      at_ = static_cast<std::size_t>(next);
    }
    return checked_blocks(block_, references_, source_);
  }

 private:
  void read_keyword(std::int32_t code, std::size_t begin) {
    if (code == code_dimension) require_space(read<std::int32_t>("dimension"), source_);
    if (code == code_vertices) read_points(begin);
    for (const MeditCells& cells : medit_cells)
      if (cells.code == code) read_cells(cells, begin);
    for (const auto& [unread, words] : unread_cells)
      if (unread == code && whole("count") > 0)
        throw scene::bad_input(
            fmt::format("{}: it has {}, which are not supported; export first-order cells", source_, words));
  }

  void read_points(std::size_t begin) {
    const std::size_t real = version_ == 1 ? sizeof(float) : sizeof(double);
    const std::size_t count = read_count(3 * real + whole_bytes(), "points", begin);
    block_.positions.reserve(count);
    for (std::size_t v = 0; v < count; ++v) {
      glm::dvec3 p;
      for (int a = 0; a < 3; ++a) p[a] = version_ == 1 ? read<float>("point") : read<double>("point");
      static_cast<void>(whole("reference"));
      block_.positions.push_back(p);
    }
  }

  void read_cells(const MeditCells& cells, std::size_t begin) {
    const std::size_t count = read_count((cells.nodes + 1) * whole_bytes(), "cells", begin);
    for (std::size_t c = 0; c < count; ++c) {
      const std::size_t first = at_;
      for (std::size_t k = 0; k < cells.nodes; ++k) {
        const std::int64_t node = whole("node");
        if (node < 1 || node >= std::numeric_limits<std::uint32_t>::max())
          fail(first, fmt::format("a cell uses point {}", node));
        block_.connectivity.push_back(static_cast<std::uint32_t>(node - 1));
      }
      references_.push_back(whole("reference"));
      block_.types.push_back(vtk_number(cells.type));
      block_.offsets.push_back(block_.connectivity.size());
    }
  }

  [[nodiscard]] std::size_t whole_bytes() const { return version_ >= 4 ? sizeof(std::int64_t) : sizeof(std::int32_t); }
  std::int64_t whole(const char* what) { return version_ >= 4 ? read<std::int64_t>(what) : read<std::int32_t>(what); }

  std::size_t read_count(std::size_t bytes_each, const char* what, std::size_t begin) {
    const std::int64_t count = whole("count");
    if (count < 0 || static_cast<std::uint64_t>(count) > (bytes_.size() - at_) / bytes_each)
      fail(begin, fmt::format("it states {} {}, more than a file of this size can contain", count, what));
    return static_cast<std::size_t>(count);
  }

  template <class T>
  T read(const char* what) {
    if (bytes_.size() - at_ < sizeof(T)) fail(at_, fmt::format("the file ends before a {}", what));
    const T value = scene::load<T>(bytes_.data() + at_, is_swapped_);
    at_ += sizeof(T);
    return value;
  }

  [[noreturn]] void fail(std::size_t at, const std::string& what) const {
    throw scene::bad_input(
        fmt::format("{}: byte {}: {}; the file is truncated or damaged, export it again", source_, at, what));
  }

  std::span<const std::byte> bytes_;
  const std::string& source_;
  bool is_swapped_ = false;
  std::int32_t version_ = 0;
  std::size_t at_ = 0;
  cells::CellBlock block_;
  std::vector<std::int64_t> references_;  ///< per cell
};

/// Words separated by blanks of any kind; line ends matter only because they end comments.
class MeditText {
 public:
  MeditText(std::string_view text, const std::string& source)
      : scanner_(text, source, ascii_blanks, '#'), source_(source) {
    block_.offsets.push_back(0);
  }

  std::vector<cells::CellBlock> blocks() {
    std::string_view list;  // name of the list that was just read
    for (std::string_view word = scanner_.word(); !word.empty() && word != "End"; word = scanner_.word()) {
      if (!list.empty() && std::string_view("+-.0123456789").find(word[0]) != std::string_view::npos)
        fail(fmt::format("the number '{}' follows the last of the {}: they have more numbers than this keyword allows",
                         word.substr(0, 40), list));
      list = {};
      if (word == "Dimension") require_space(whole("a dimension"), source_);
      if (word == "Vertices") read_points(), list = word;
      for (const MeditCells& cells : medit_cells)
        if (word == cells.word) read_cells(cells), list = word;
      if (is_unread(word) && whole("a count") > 0)
        scanner_.fail(fmt::format("its {} are not supported; export first-order cells", word));
      // The numbers of other keywords are skipped one by one.
    }
    return checked_blocks(block_, references_, source_);
  }

 private:
  /// Volume cells of higher order (TetrahedraP3, HexahedraQ2, Prisms9), other node orders, and polyhedra.
  static bool is_unread(std::string_view word) {
    constexpr std::array<std::string_view, 4> families = {"Tetrahedra", "Prisms", "Hexahedra", "Pyramids"};
    const auto is_curved = [&](std::string_view family) {
      return word.size() > family.size() && word.starts_with(family) &&
             std::string_view("PQ0123456789").find(word[family.size()]) != std::string_view::npos;
    };
    return (word != "TetrahedraP2" && std::ranges::any_of(families, is_curved)) || word == "Polyhedra" ||
           word == "PolyhedraHeaders";
  }

  void read_points() {
    const std::size_t count = read_count(8, "points");  // four numbers and their separators
    block_.positions.reserve(count);
    for (std::size_t v = 0; v < count; ++v) {
      glm::dvec3 p;
      for (int a = 0; a < 3; ++a) p[a] = number<double>("a coordinate");
      static_cast<void>(whole("a reference"));
      block_.positions.push_back(p);
    }
  }

  void read_cells(const MeditCells& cells) {
    const std::size_t count = read_count(2 * (cells.nodes + 1), "cells");
    for (std::size_t c = 0; c < count; ++c) {
      for (std::size_t k = 0; k < cells.nodes; ++k) {
        const std::int64_t node = whole("a point of a cell");
        if (node < 1 || node >= std::numeric_limits<std::uint32_t>::max())
          fail(fmt::format("a cell uses point {}", node));
        block_.connectivity.push_back(static_cast<std::uint32_t>(node - 1));
      }
      references_.push_back(whole("a reference"));
      block_.types.push_back(vtk_number(cells.type));
      block_.offsets.push_back(block_.connectivity.size());
    }
  }

  std::size_t read_count(std::size_t bytes_each, const char* what) {
    const std::int64_t count = whole("a count");
    if (count < 0 || static_cast<std::uint64_t>(count) > scanner_.rest().size() / bytes_each + 1)
      fail(fmt::format("it states {} {}, more than a file of this size can contain", count, what));
    return static_cast<std::size_t>(count);
  }

  std::int64_t whole(const char* what) { return number<std::int64_t>(what); }

  template <class T>
  T number(const char* what) {
    T value{};
    const Scanned found = scanner_.number(value);
    if (found == Scanned::nothing) fail(fmt::format("the file ends before {}", what));
    if (found == Scanned::other_word) fail(fmt::format("'{}' is not {}", scanner_.word().substr(0, 40), what));
    if (found == Scanned::out_of_range) fail(fmt::format("{} is out of range", what));
    return value;
  }

  [[noreturn]] void fail(const std::string& what) const {
    scanner_.fail(what + "; the file is truncated or damaged, export it again");
  }

  TextScanner scanner_;
  const std::string& source_;
  cells::CellBlock block_;
  std::vector<std::int64_t> references_;  ///< per cell
};

}  // namespace

std::vector<cells::CellBlock> parse_medit_binary(std::span<const std::byte> bytes, const std::string& source) {
  const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  if (!begins_as_medit_binary(text.substr(0, 24)))
    throw scene::bad_input(fmt::format("{}: it does not begin like a binary Medit mesh; check what it is", source));
  return MeditBinary(bytes, source).blocks();
}

std::vector<cells::CellBlock> parse_medit_text(std::string_view text, const std::string& source) {
  if (!begins_as_medit_text(text.substr(0, 128)))
    throw scene::bad_input(fmt::format("{}: it does not begin like a Medit mesh; check what it is", source));
  return MeditText(text, source).blocks();
}

cells::MeshBlocks read_medit_text(const InputFile& file, const MeshOptions& /*options*/) {
  return {parse_medit_text(WholeFile(file.path).text(), file.name), {}, "Medit"};
}

cells::MeshBlocks read_medit_binary(const InputFile& file, const MeshOptions& /*options*/) {
  return {parse_medit_binary(WholeFile(file.path).bytes(), file.name), {}, "Medit, binary"};
}

}  // namespace tessera::io
