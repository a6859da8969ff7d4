// SPDX-License-Identifier: BSD-3-Clause
#include "io/mesh/plot3d_layout.hpp"

#include <fmt/format.h>

#include <cstring>
#include <fstream>
#include <optional>
#include <string>

#include "io/files/input_file.hpp"
#include "io/files/whole_file.hpp"
#include "io/mesh/plot3d_text.hpp"
#include "scene/byte_order.hpp"
#include "scene/error.hpp"

namespace tessera::io {
namespace {

/// Reads the records of a file under the assumption of a layout; `good` becomes false if the records do not match the
/// layout.
class Walk {
 public:
  Walk(std::ifstream& in, std::uint64_t size, const Plot3dLayout& layout) : in_(in), size_(size), layout_(layout) {}

  bool good = true;

  /// Reads the next int32, inside a record.
  std::int32_t number() {
    std::int32_t value = 0;
    if (!fits(4)) return 0;
    in_.clear();
    in_.seekg(static_cast<std::streamoff>(at_));
    in_.read(reinterpret_cast<char*>(&value), 4);
    at_ += 4;
    return scene::is_swapped(layout_.big_endian) ? scene::byteswapped(value) : value;
  }

  void skip(std::uint64_t bytes) {
    if (fits(bytes)) at_ += bytes;
  }

  /// Reads a record mark, which must equal the length of the record.
  void mark(std::uint64_t bytes) {
    if (!layout_.record_marks) return;
    if (static_cast<std::uint32_t>(number()) != bytes) good = false;
  }

  void record(std::uint64_t bytes) {
    mark(bytes);
    skip(bytes);
    mark(bytes);
  }

  [[nodiscard]] bool at_end() const { return good && at_ == size_; }
  [[nodiscard]] std::uint64_t left() const { return size_ - at_; }

  /// Reads the number of grids, then the number of points along i, j, k of each grid.
  std::vector<std::array<std::int32_t, 3>> dimensions() {
    std::int32_t grids = 1;
    if (layout_.multi_grid) {
      mark(4);
      grids = number();
      mark(4);
    }
    // Each grid takes at least the 12 bytes of its dimensions, which bounds the allocation.
    if (!good || grids < 1 || static_cast<std::uint64_t>(grids) > size_ / 12) {
      good = false;
      return {};
    }
    std::vector<std::array<std::int32_t, 3>> result(static_cast<std::size_t>(grids));
    const std::uint64_t bytes = 12 * result.size();
    mark(bytes);
    for (auto& grid : result)
      for (std::int32_t& n : grid) {
        if (good) n = number();
        if (n < 1) good = false;
      }
    mark(bytes);
    return result;
  }

  /// Returns the number of points of a grid; 0 if the file is too small for them.
  std::uint64_t points(const std::array<std::int32_t, 3>& n) {
    std::uint64_t product = 1;
    for (const std::int32_t side : n) {
      product *= static_cast<std::uint64_t>(side);  // both factors are below 2^32, because size_ bounds each product
      if (product > size_ || product > UINT32_MAX) {
        good = false;
        return 0;
      }
    }
    return product;
  }

 private:
  bool fits(std::uint64_t bytes) {
    good = good && bytes <= size_ - at_;
    return good;
  }

  std::ifstream& in_;
  std::uint64_t size_, at_ = 0;
  const Plot3dLayout& layout_;
};

/// Whether the grid file has this layout. With `by_planes` each plane of a grid is a record.
bool grid_fits(std::ifstream& in, std::uint64_t size, Plot3dLayout& layout, bool by_planes = false) {
  Walk walk(in, size, layout);
  layout.grids = walk.dimensions();
  const std::uint64_t point_bytes = (layout.double_precision ? 24 : 12) + (layout.iblank ? 4 : 0);
  for (const auto& n : layout.grids) {
    if (!walk.good) return false;
    const std::uint64_t points = walk.points(n);
    const auto records = static_cast<std::uint64_t>(by_planes ? n[2] : 1);
    for (std::uint64_t k = 0; k < records && walk.good; ++k) walk.record(points / records * point_bytes);
  }
  return walk.at_end();
}

bool is_text(const std::filesystem::path& file) {
  for (const char c : read_beginning(file, 256))
    if (c != '\n' && c != '\r' && c != '\t' && (c < ' ' || c > '~')) return false;
  return true;
}

}  // namespace

Plot3dLayout detect_plot3d(const std::filesystem::path& grid_file) {
  const std::uint64_t size = require_file(grid_file);
  if (is_text(grid_file)) {
    if (const auto layout = plot3d_text_layout(WholeFile(grid_file).text(), grid_file.string())) return *layout;
    throw scene::bad_input(
        fmt::format("{}: its numbers fit no layout of a three-dimensional PLOT3D grid; it is truncated or of another "
                    "kind (give a solution file with `q`)",
                    grid_file.string()));
  }
  std::ifstream in(grid_file, std::ios::binary);
  for (unsigned bits = 0; bits < 32; ++bits) {
    Plot3dLayout layout{(bits & 1) == 0, (bits & 2) != 0, (bits & 4) != 0, (bits & 8) != 0, (bits & 16) != 0, {}};
    if (grid_fits(in, size, layout)) return layout;
    if (layout.record_marks && grid_fits(in, size, layout, true))
      throw scene::bad_input(
          fmt::format("{}: it has a record for each plane of a grid (/PLANES), which is not supported; write each grid "
                      "as one record (/WHOLE)",
                      grid_file.string()));
  }
  throw scene::bad_input(
      fmt::format("{}: no layout of a three-dimensional binary PLOT3D grid has {} bytes; it is truncated or of another "
                  "kind (give a solution file with `q`)",
                  grid_file.string(), size));
}

std::uint64_t check_plot3d_solution(const std::filesystem::path& q_file, const Plot3dLayout& layout) {
  const std::uint64_t size = require_file(q_file);
  if (layout.is_text) {
    if (is_text(q_file)) return check_plot3d_text_solution(WholeFile(q_file).text(), layout, q_file.string());
    throw scene::bad_input(fmt::format(
        "{}: it is binary, but the grid file is text; give both as text or both as binary", q_file.string()));
  }
  std::ifstream in(q_file, std::ios::binary);
  Walk walk(in, size, layout);
  if (walk.dimensions() != layout.grids || !walk.good)
    throw scene::bad_input(fmt::format(
        "{}: its dimensions differ from those of the grid file; give the solution for this grid", q_file.string()));
  const std::uint64_t number_bytes = layout.double_precision ? 8 : 4;
  for (const auto& n : layout.grids) {
    walk.record(4 * number_bytes);
    walk.record(5 * number_bytes * walk.points(n));
  }
  if (!walk.good)
    throw scene::bad_input(
        fmt::format("{}: its {} bytes are not the 4 + 5 n numbers per grid of a PLOT3D solution; it is truncated or of "
                    "another kind (function file, OVERFLOW)",
                    q_file.string(), size));
  return walk.left();
}

std::filesystem::path find_plot3d_solution(const std::filesystem::path& grid_file) {
  const std::string stem = grid_file.stem().string();
  std::vector<std::filesystem::path> names;
  if (const std::size_t at = stem.rfind("xyz"); at != std::string::npos)
    names.push_back(grid_file.parent_path() /
                    fmt::format("{}q{}{}", stem.substr(0, at), stem.substr(at + 3), grid_file.extension().string()));
  for (const char* extension : {".q", ".Q"}) names.push_back(grid_file.parent_path() / (stem + extension));
  for (const std::filesystem::path& name : names)
    if (std::error_code error; name != grid_file && std::filesystem::is_regular_file(name, error)) return name;
  return {};
}

}  // namespace tessera::io
