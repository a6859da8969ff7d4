#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <optional>
#include <vector>

#include "io/mapped_file.hpp"
#include "io/vtk_checks.hpp"
#include "scene/error.hpp"

namespace tessera::io {
namespace {

/// The value of an attribute in the text of one tag; none if the tag lacks it.
std::optional<std::string_view> attribute(std::string_view tag, std::string_view name) {
  for (std::size_t at = tag.find(name); at != std::string_view::npos; at = tag.find(name, at + 1)) {
    if (at == 0 || std::string_view(" \t\r\n").find(tag[at - 1]) == std::string_view::npos) continue;
    std::size_t next = tag.find_first_not_of(" \t\r\n", at + name.size());
    if (next == std::string_view::npos || tag[next] != '=') continue;
    next = tag.find_first_of("\"'", next);
    if (next == std::string_view::npos) return std::nullopt;
    const std::size_t close = tag.find(tag[next], next + 1);
    if (close == std::string_view::npos) return std::nullopt;
    return tag.substr(next + 1, close - next - 1);
  }
  return std::nullopt;
}

/// Reads whole numbers until the text ends; none if it holds anything else.
std::optional<std::vector<std::int64_t>> numbers(std::string_view text) {
  std::vector<std::int64_t> values;
  while (true) {
    const std::size_t start = text.find_first_not_of(" \t\r\n");
    if (start == std::string_view::npos) return values;
    text.remove_prefix(start);
    std::int64_t value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() ||
        (end != text.data() + text.size() && std::string_view(" \t\r\n").find(*end) == std::string_view::npos))
      return std::nullopt;
    values.push_back(value);
    text.remove_prefix(static_cast<std::size_t>(end - text.data()));
  }
}

class XmlCheck {
 public:
  XmlCheck(std::string_view text, const std::string& source) : text_(text), source_(source) {
    // zlib's best is 1032 to 1; every cell has at least a byte of type, every point 12 of coordinates.
    const std::size_t head = text.find('>', text.find("<VTKFile"));
    const bool compressed = text.substr(0, head).find("compressor") != std::string_view::npos;
    most_values_ = static_cast<std::uint64_t>(text.size()) * (compressed ? 1040 : 1);
    // What follows is raw bytes.
    const std::size_t appended = text.find("<AppendedData");
    text_ = text.substr(0, appended);
  }

  /// Calls `visit` with the text of each tag <name ...>.
  template <class Visit>
  void each_tag(std::string_view name, const Visit& visit) const {
    const std::string open = fmt::format("<{}", name);
    for (std::size_t at = text_.find(open); at != std::string_view::npos; at = text_.find(open, at + 1)) {
      const std::size_t end = text_.find('>', at);
      if (end == std::string_view::npos) fail(fmt::format("the tag <{} is not closed", name));
      const std::size_t after = at + open.size();
      if (std::string_view(" \t\r\n/>").find(text_[after]) != std::string_view::npos)
        visit(text_.substr(after, end - after));
    }
  }

  void check() const {
    each_tag("Piece", [&](std::string_view tag) {
      for (const char* name :
           {"NumberOfPoints", "NumberOfCells", "NumberOfVerts", "NumberOfLines", "NumberOfStrips", "NumberOfPolys"})
        check_count(tag, name);
      check_extent(tag, "Extent");
    });
    for (const char* grid : {"StructuredGrid", "RectilinearGrid", "PStructuredGrid", "PRectilinearGrid", "PImageData"})
      each_tag(grid, [&](std::string_view tag) { check_extent(tag, "WholeExtent"); });
    each_tag("ImageData", [&](std::string_view tag) { check_image(tag); });
    for (const char* array : {"DataArray", "Array", "PDataArray"})
      each_tag(array, [&](std::string_view tag) {
        check_count(tag, "NumberOfComponents");
        check_count(tag, "NumberOfTuples");
      });
  }

  /// Values that the file could hold at most.
  [[nodiscard]] std::uint64_t most_values() const { return most_values_; }

  /// Cells of an extent, at least one along each axis.
  [[nodiscard]] static double cells_of(std::string_view tag, const char* name) {
    const auto text = attribute(tag, name);
    const auto values = text ? numbers(*text) : std::nullopt;
    double cells = 1;
    for (std::size_t axis = 0; values && values->size() == 6 && axis < 3; ++axis)
      cells *= std::max(1.0, static_cast<double>((*values)[2 * axis + 1]) - static_cast<double>((*values)[2 * axis]));
    return cells;
  }

  [[noreturn]] void fail(const std::string& what) const {
    throw scene::bad_input(fmt::format("{}: {}; the file is truncated or damaged, write it anew", source_, what));
  }

 private:
  void check_count(std::string_view tag, const char* name) const {
    const std::optional<std::string_view> text = attribute(tag, name);
    if (!text) return;
    const auto values = numbers(*text);
    if (!values || values->size() != 1 || values->front() < 0 ||
        static_cast<std::uint64_t>(values->front()) > most_values_)
      fail(fmt::format("{} is '{}', a file of {} bytes cannot hold that", name, text->substr(0, 30), text_.size()));
  }

  void check_extent(std::string_view tag, const char* name) const {
    const std::optional<std::string_view> text = attribute(tag, name);
    if (!text) return;
    const auto values = numbers(*text);
    double points = 1;  // a product of three differences below 2^33
    if (!values || values->size() != 6)
      fail(fmt::format("{} is '{}', not six whole numbers", name, text->substr(0, 60)));
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const std::int64_t low = (*values)[2 * axis], high = (*values)[2 * axis + 1];
      if (low < INT32_MIN || high > INT32_MAX || low > high + 1)
        fail(fmt::format("{} '{}' runs from {} to {}", name, text->substr(0, 60), low, high));
      points *= static_cast<double>(high - low + 1);
    }
    if (points > 4294967295.0)
      fail(fmt::format("{} '{}' has {:.3g} points, at most 2^32 - 1 are read", name, text->substr(0, 60), points));
  }

  /// An image has a number for each cell at least, if it has any; eight bits are a byte.
  void check_image(std::string_view tag) const {
    check_extent(tag, "WholeExtent");
    if (cells_of(tag, "WholeExtent") > 8.0 * static_cast<double>(most_values_))
      fail(fmt::format("WholeExtent is '{}', a file of {} bytes cannot hold that",
                       attribute(tag, "WholeExtent").value_or(""), text_.size()));
  }

  std::string_view text_;
  const std::string& source_;
  std::uint64_t most_values_ = 0;
};

}  // namespace

void check_vtk_xml(const std::filesystem::path& file) {
  const std::string source = file.string();
  std::vector<std::filesystem::path> pieces;
  double grid_cells = 0, most_values = 0;
  {
    const MappedFile mapped(file);
    const XmlCheck check(mapped.text(), source);
    check.check();
    check.each_tag("Piece", [&](std::string_view tag) {
      if (const auto name = attribute(tag, "Source"))
        pieces.push_back(file.parent_path() / std::filesystem::path(*name));
    });
    for (const char* grid : {"PImageData", "PRectilinearGrid", "PStructuredGrid"})
      check.each_tag(grid, [&](std::string_view tag) { grid_cells = XmlCheck::cells_of(tag, "WholeExtent"); });
  }
  for (const std::filesystem::path& piece : pieces) {
    // A piece is no parallel file: one level, so that a file that names itself ends here.
    const std::string piece_source = piece.string();
    const MappedFile mapped(piece);
    if (mapped.text().substr(0, 4096).find("<VTKFile") == std::string_view::npos)
      throw scene::bad_input(
          fmt::format("{}: it is a piece of {} and does not begin as a VTK XML file does; write it "
                      "anew",
                      piece_source, source));
    const XmlCheck check(mapped.text(), piece_source);
    check.check();
    most_values += static_cast<double>(check.most_values());
  }
  if (grid_cells > 8 * most_values)
    throw scene::bad_input(
        fmt::format("{}: its WholeExtent has {:.3g} cells, its {} pieces cannot hold them; the file "
                    "is damaged, write it anew",
                    source, grid_cells, pieces.size()));
}

}  // namespace tessera::io
