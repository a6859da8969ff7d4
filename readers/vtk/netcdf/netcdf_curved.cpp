// SPDX-License-Identifier: BSD-3-Clause
#include "readers/vtk/netcdf/netcdf_curved.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "readers/vtk/netcdf/netcdf_values.hpp"

namespace tessera::readers {
namespace {

/// Whether a variable has both horizontal dimensions, and no other dimensions except those of steps.
bool is_horizontal(const NetcdfVariable& candidate, const NetcdfVariable& variable, const AxisOrder& order) {
  std::size_t in_space = 0;
  for (const NetcdfDimension& dimension : candidate.dimensions) {
    const auto is_it = [&](std::size_t d) { return variable.dimensions[d].id == dimension.id; };
    if (is_it(order.along[0]) || is_it(order.along[1]))
      ++in_space;
    else if (std::none_of(order.steps.begin(), order.steps.end(), is_it))
      return false;
  }
  return in_space == 2;
}

CurvedCoordinates coordinates_among(const NetcdfFile& file, const std::vector<const NetcdfVariable*>& candidates,
                                    const NetcdfVariable& variable, const AxisOrder& order) {
  CurvedCoordinates found;
  for (const NetcdfVariable* const candidate : candidates) {
    if (!is_horizontal(*candidate, variable, order)) continue;
    const AxisRole role = role_of(file, *candidate);
    if (role == AxisRole::x && found.x == nullptr) found.x = candidate;
    if (role == AxisRole::y && found.y == nullptr) found.y = candidate;
  }
  return found;
}

bool have_same_dimensions(const NetcdfVariable& a, const NetcdfVariable& b) {
  return std::equal(a.dimensions.begin(), a.dimensions.end(), b.dimensions.begin(), b.dimensions.end(),
                    [](const NetcdfDimension& left, const NetcdfDimension& right) { return left.id == right.id; });
}

/// Reads a horizontal coordinate with x as the fastest dimension. If `corners` is 4, reads the coordinate's bounds
/// instead; the four corners of a cell are then consecutive.
std::vector<double> read_horizontal(const NetcdfFile& file, const NetcdfVariable& coordinate,
                                    const NetcdfVariable& variable, const AxisOrder& order,
                                    std::span<const std::size_t> step_indices, std::size_t corners) {
  std::vector<std::size_t> first, counts;
  GridAxes along{};
  std::size_t extra = coordinate.dimensions.size();
  for (std::size_t c = 0; c < coordinate.dimensions.size(); ++c) {
    first.push_back(0), counts.push_back(coordinate.dimensions[c].length);
    const auto is_it = [&](std::size_t d) { return variable.dimensions[d].id == coordinate.dimensions[c].id; };
    if (is_it(order.along[0])) {
      along[0] = c;
    } else if (is_it(order.along[1])) {
      along[1] = c;
    } else if (const auto step = std::find_if(order.steps.begin(), order.steps.end(), is_it);
               step != order.steps.end()) {
      first.back() = step_indices[static_cast<std::size_t>(step - order.steps.begin())], counts.back() = 1;
    } else {
      extra = c;
    }
  }
  GridNumbers numbers = read_values(file, coordinate, first, counts).numbers;
  const std::size_t width = io::size_of(numbers.type) * corners;
  if (corners > 1) {
    if (extra + 1 != counts.size()) return {};  // corners are the fastest dimension (CF 7.1)
    counts.back() = 1;
  }
  counts.push_back(1);  // the length of the missing z axis
  along[2] = counts.size() - 1;
  numbers.bytes = in_grid_order(std::move(numbers.bytes), width, counts, along);
  return numbers.as_doubles();
}

using Corners = std::array<std::vector<double>, 2>;  // longitudes, latitudes: four per cell, x fastest
using Order = std::array<std::size_t, 4>;            // which corners are at (0, 0), (1, 0), (1, 1), (0, 1)

/// Returns the sum of the distances between corners that adjacent cells should share, if cells list their corners in
/// this order.
double mismatch_of(const Corners& corners, std::size_t columns, std::size_t rows, const Order& order) {
  double sum = 0;
  const auto add = [&](std::size_t cell, std::size_t corner, std::size_t other, std::size_t of_other) {
    for (const std::vector<double>& axis : corners)
      if (const double gap = std::abs(axis[4 * cell + order[corner]] - axis[4 * other + order[of_other]]);
          std::isfinite(gap))
        sum += gap;
  };
  for (std::size_t j = 0; j < rows; ++j)
    for (std::size_t i = 0; i < columns; ++i) {
      const std::size_t cell = j * columns + i;
      if (i + 1 < columns) add(cell, 1, cell + 1, 0), add(cell, 2, cell + 1, 3);
      if (j + 1 < rows) add(cell, 3, cell + columns, 0), add(cell, 2, cell + columns, 1);
    }
  return sum;
}

/// Finds the order of corners. CF 7.1 lists them around a cell, but the first may be any corner, and the direction is
/// not defined.
Order order_of_corners(const Corners& corners, std::size_t columns, std::size_t rows) {
  Order best{0, 1, 2, 3};
  double least = std::numeric_limits<double>::infinity();
  for (const bool turned : {false, true})
    for (std::size_t start = 0; start < 4; ++start) {
      Order order{};
      for (std::size_t k = 0; k < 4; ++k) order[k] = (start + (turned ? 4 - k : k)) % 4;
      if (const double mismatch = mismatch_of(corners, columns, rows, order); mismatch < least)
        least = mismatch, best = order;
    }
  return best;
}

/// Computes the points between cells, x fastest, from the corners of the adjacent cells.
Corners lattice_of(const Corners& corners, std::size_t columns, std::size_t rows) {
  const Order order = order_of_corners(corners, columns, rows);
  Corners lattice;
  for (std::size_t a = 0; a < 2; ++a)
    for (std::size_t j = 0; j <= rows; ++j)
      for (std::size_t i = 0; i <= columns; ++i) {
        double value = std::numeric_limits<double>::quiet_NaN();  // NaN until a value of an adjacent cell is found
        for (const std::size_t down : {0u, 1u})
          for (const std::size_t left : {0u, 1u}) {
            if (i + 1 < 1 + left || j + 1 < 1 + down || i - left >= columns || j - down >= rows) continue;
            const std::size_t corner = down == 0 ? left : 3 - left;
            const double known = corners[a][4 * ((j - down) * columns + i - left) + order[corner]];
            if (!std::isfinite(value)) value = known;
          }
        lattice[a].push_back(value);
      }
  return lattice;
}

}  // namespace

std::optional<CurvedCoordinates> curved_coordinates_of(const NetcdfFile& file, const NetcdfVariable& variable,
                                                       const AxisOrder& order) {
  const auto found_in = [&](const std::vector<const NetcdfVariable*>& candidates) {
    const CurvedCoordinates found = coordinates_among(file, candidates, variable, order);
    return found.x != nullptr && found.y != nullptr ? std::optional(found) : std::nullopt;
  };
  if (const auto own = found_in(named_coordinates(file, variable))) return own;
  for (const NetcdfVariable& other : file.variables())
    if (have_same_dimensions(other, variable))
      if (const auto others = found_in(named_coordinates(file, other))) return others;
  // If a horizontal dimension has a coordinate variable, the grid is rectilinear, perhaps in projected coordinates.
  if (coordinate_of(file, variable, variable.dimensions[order.along[0]]) != nullptr ||
      coordinate_of(file, variable, variable.dimensions[order.along[1]]) != nullptr)
    return std::nullopt;
  std::vector<const NetcdfVariable*> all;
  for (const NetcdfVariable& other : file.variables())
    if (file.text(other, "units").starts_with("degree")) all.push_back(&other);
  return found_in(all);
}

CurvedGrid curved_grid(const NetcdfFile& file, const NetcdfVariable& variable, const AxisOrder& order,
                       std::span<const std::size_t> step_indices, const CurvedCoordinates& coordinates,
                       std::span<const double> z, std::span<const double> z_bounds, std::vector<std::string>& notes) {
  const std::size_t columns = variable.dimensions[order.along[0]].length,
                    rows = variable.dimensions[order.along[1]].length;
  CurvedGrid grid;
  Corners places;
  const std::array<const NetcdfVariable*, 2> axes = {coordinates.x, coordinates.y};
  for (std::size_t a = 0; a < 2; ++a) {
    const NetcdfVariable* const bounds = file.find(*axes[a], file.text(*axes[a], "bounds"));
    if (bounds == nullptr || bounds->dimensions.size() < 3 || bounds->dimensions.back().length != 4) continue;
    std::vector<double> corners = read_horizontal(file, *bounds, variable, order, step_indices, 4);
    if (corners.size() == 4 * columns * rows) places[a] = std::move(corners);
  }
  grid.has_cells = !places[0].empty() && !places[1].empty();
  if (grid.has_cells)
    places = lattice_of(places, columns, rows);
  else
    for (std::size_t a = 0; a < 2; ++a) places[a] = read_horizontal(file, *axes[a], variable, order, step_indices, 1);
  if (std::any_of(axes.begin(), axes.end(),
                  [&](const NetcdfVariable* axis) { return !file.text(*axis, "bounds").empty(); }) &&
      !grid.has_cells)
    notes.emplace_back(
        "the bounds of its cells cannot be found: values are placed at the given points, with cells between them");
  const std::span<const double> heights = grid.has_cells ? z_bounds : z;
  const std::size_t more = grid.has_cells ? 1 : 0;
  grid.points = {columns + more, rows + more, heights.size()};
  grid.positions.reserve(3 * places[0].size() * heights.size());
  for (const double height : heights)
    for (std::size_t p = 0; p < places[0].size(); ++p)
      grid.positions.insert(grid.positions.end(), {places[0][p], places[1][p], height});
  return grid;
}

}  // namespace tessera::readers
