// SPDX-License-Identifier: BSD-3-Clause
// NetCDF grids by the CF conventions ("NetCDF Climate and Forecast Metadata Conventions"), read by NetCDF's library
// itself: VTK 9.1's reader makes assumptions about the order of axes, unsigned and 64-bit numbers and missing values.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numeric>
#include <set>
#include <string_view>
#include <vector>

#include "readers/common/readers.hpp"
#include "readers/common/serve.hpp"
#include "readers/vtk/netcdf/netcdf_axes.hpp"
#include "readers/vtk/netcdf/netcdf_curved.hpp"
#include "readers/vtk/netcdf/netcdf_values.hpp"
#include "scene/error.hpp"
#include "tessera/program/text.hpp"

namespace tessera::readers {
namespace {

struct GridVariable {
  const NetcdfVariable* variable = nullptr;
  AxisOrder order;
};

/// Variables that have the same spatial axes, and so are fields of the same grid.
struct GridOfVariables {
  std::string dimensions;  ///< dimensions as text, "(lev, lat, lon)"
  std::array<int, 3> ids{};
  std::optional<CurvedCoordinates> curved;
  bool is_flat = false;
  std::vector<GridVariable> fields;
};

std::string dimension_words(const GridVariable& field) {
  std::vector<std::string> names;
  for (std::size_t d = 0; d < field.variable->dimensions.size(); ++d)
    if (std::find(field.order.along.begin(), field.order.along.end(), d) != field.order.along.end())
      names.push_back(field.variable->dimensions[d].name);
  return fmt::format("({})", fmt::join(names, ", "));
}

bool are_same(const std::optional<CurvedCoordinates>& a, const std::optional<CurvedCoordinates>& b) {
  return a.has_value() == b.has_value() && (!a || (a->x == b->x && a->y == b->y));
}

/// Returns the variables that contain bounds of coordinates (CF 7.1), and so are not fields.
std::set<const NetcdfVariable*> bounds_in(const NetcdfFile& file) {
  std::set<const NetcdfVariable*> bounds;
  for (const NetcdfVariable& variable : file.variables())
    for (const char* const attribute : {"bounds", "climatology"})
      if (const std::string name = file.text(variable, attribute); !name.empty())
        bounds.insert(file.find(variable, name));
  return bounds;
}

/// Returns all grids of variables with three spatial dimensions.
std::vector<GridOfVariables> grids_of(const NetcdfFile& file) {
  std::vector<GridOfVariables> grids;
  const std::set<const NetcdfVariable*> bounds = bounds_in(file);
  for (const NetcdfVariable& variable : file.variables()) {
    const bool is_empty = std::any_of(variable.dimensions.begin(), variable.dimensions.end(),
                                      [](const NetcdfDimension& dimension) { return dimension.length == 0; });
    const std::optional<AxisOrder> order = axes_of(file, variable);
    if (!order || is_empty || bounds.contains(&variable)) continue;
    GridOfVariables its;
    for (std::size_t a = 0; a < 3; ++a) its.ids[a] = variable.dimensions[order->along[a]].id;
    its.curved = curved_coordinates_of(file, variable, *order);
    auto grid = std::find_if(grids.begin(), grids.end(), [&](const GridOfVariables& g) {
      return g.ids == its.ids && are_same(g.curved, its.curved);
    });
    if (grid == grids.end()) {
      its.dimensions = dimension_words({&variable, *order});
      its.is_flat = std::any_of(order->along.begin(), order->along.end(),
                                [&](std::size_t d) { return variable.dimensions[d].length < 2; });
      grid = grids.insert(grids.end(), std::move(its));
    }
    grid->fields.push_back({&variable, *order});
  }
  return grids;
}

/// Whether a requested field ("point:NAME", "NAME:0", ...) names this variable.
bool means(std::string_view field, const std::string& name) {
  for (const std::string_view side : {"point:", "cell:"})
    if (field.starts_with(side) && field != name) field.remove_prefix(side.size());
  return field == name || (field.starts_with(name) && field.substr(name.size()).starts_with(':'));
}

/// Returns the grid that has the field, otherwise the one with the most variables, the first of several. A note names
/// the others.
const GridOfVariables& choose_grid(const std::vector<GridOfVariables>& grids, const std::string& field,
                                   std::vector<std::string>& notes) {
  const GridOfVariables* chosen = &grids.front();
  for (const GridOfVariables& grid : grids)
    if (grid.is_flat != chosen->is_flat ? chosen->is_flat : grid.fields.size() > chosen->fields.size()) chosen = &grid;
  for (const GridOfVariables& grid : grids)
    if (std::any_of(grid.fields.begin(), grid.fields.end(),
                    [&](const GridVariable& f) { return means(field, f.variable->path); }))
      chosen = &grid;
  for (const GridOfVariables& grid : grids)
    if (&grid != chosen)
      notes.push_back(fmt::format("another grid, {}, has {}{}: to show it, name a variable with `field`",
                                  grid.dimensions, grid.fields.front().variable->path,
                                  grid.fields.size() > 1 ? ", ..." : ""));
  return *chosen;
}

std::size_t steps_of(const GridVariable& field) {
  double all = 1;
  for (const std::size_t d : field.order.steps) all *= static_cast<double>(field.variable->dimensions[d].length);
  return field.order.steps.empty() || all > 1e15 ? 0 : static_cast<std::size_t>(all);
}

/// Returns the indices of a step along the dimensions that are not spatial; the last of them is the fastest.
std::vector<std::size_t> indices_of(const GridVariable& field, std::size_t step) {
  std::vector<std::size_t> indices(field.order.steps.size());
  for (std::size_t k = indices.size(); k-- > 0;) {
    const std::size_t length = std::max<std::size_t>(field.variable->dimensions[field.order.steps[k]].length, 1);
    indices[k] = step % length;
    step /= length;
  }
  return indices;
}

/// If the only dimension of steps is time, returns its coordinates unchanged. Returns an empty list if that dimension
/// is not time, or if several dimensions of steps have more than one entry.
std::vector<double> times_of(const NetcdfFile& file, const GridVariable& field) {
  std::vector<double> times;
  for (const std::size_t d : field.order.steps) {
    const NetcdfDimension& dimension = field.variable->dimensions[d];
    if (dimension.length > 1 && steps_of(field) > dimension.length) return {};
    if (dimension.length < steps_of(field)) continue;
    const NetcdfVariable* const coordinate = coordinate_of(file, *field.variable, dimension);
    if (coordinate != nullptr && role_of(file, *coordinate) == AxisRole::time)
      times = read_whole(file, *coordinate, dimension.length).as_doubles();
  }
  return times;
}

/// Adds a note if axes other than time are used as steps.
void note_steps(const NetcdfFile& file, const GridVariable& field, std::vector<std::string>& notes) {
  std::vector<std::string> names;
  bool is_time = true;
  for (const std::size_t d : field.order.steps) {
    const NetcdfDimension& dimension = field.variable->dimensions[d];
    if (dimension.length < 2) continue;
    const NetcdfVariable* const coordinate = coordinate_of(file, *field.variable, dimension);
    NetcdfVariable named{.name = dimension.name, .path = {}, .dimensions = {}};
    is_time = is_time && role_of(file, coordinate != nullptr ? *coordinate : named) == AxisRole::time;
    names.push_back(fmt::format("{} ({})", dimension.name, dimension.length));
  }
  if (!names.empty() && !is_time)
    notes.push_back(fmt::format("time steps are counted along {}{}", fmt::join(names, " and "),
                                names.size() > 1 ? ", the last the fastest" : ""));
}

GridNumbers unit_steps(std::size_t count) {
  std::vector<double> steps(count);
  std::iota(steps.begin(), steps.end(), 0.0);
  return numbers_of(steps);
}

bool has_degrees(const NetcdfFile& file, const NetcdfVariable& coordinate) {
  const AxisRole role = role_of(file, coordinate);
  return file.text(coordinate, "units").starts_with("degree") && (role == AxisRole::x || role == AxisRole::y);
}

/// Adds multiples of 360 degrees to longitudes beyond the end of the circle, so that all longitudes are monotonic.
void unwind(std::vector<double>& longitudes) {
  const bool rises = longitudes.size() > 2 && longitudes[1] > longitudes[0];
  for (std::size_t k = 1; k < longitudes.size(); ++k) {
    const double step = longitudes[k] - longitudes[k - 1];
    if (std::abs(step) > 180 && std::abs(step) <= 720 && (step < 0) == rises)
      longitudes[k] += 360 * std::ceil((std::abs(step) - 180) / 360) * (rises ? 1 : -1);
  }
}

/// Returns the coordinates along an axis in the order in which they are drawn: z increases upwards.
GridNumbers coordinates_along(const NetcdfFile& file, const GridVariable& field, std::size_t axis,
                              std::vector<std::string>& notes) {
  const NetcdfDimension& dimension = field.variable->dimensions[field.order.along[axis]];
  const NetcdfVariable* const coordinate = coordinate_of(file, *field.variable, dimension);
  if (coordinate == nullptr) return unit_steps(dimension.length);
  GridNumbers numbers = read_whole(file, *coordinate, dimension.length);
  std::vector<double> values = numbers.as_doubles();
  if (axis == 0 && has_degrees(file, *coordinate)) unwind(values);
  if (axis == 2 && counts_downwards(file, *coordinate)) {
    for (double& value : values) value = -value;
    const std::string units = file.text(*coordinate, "units");
    notes.push_back(fmt::format("{} increases downwards: z is its negative{}", quote(dimension.name),
                                units.empty() ? "" : ", in " + quote(units)));
  }
  return numbers_of(values, numbers.type == NumberType::float32 ? NumberType::float32 : NumberType::float64);
}

/// Returns the boundaries of the levels, which is one more value than levels: the bounds of the coordinate if adjacent
/// bounds match, otherwise the midpoints between levels.
std::vector<double> levels_between(const NetcdfFile& file, const GridVariable& field, const std::vector<double>& z) {
  std::vector<double> between;
  const NetcdfDimension& dimension = field.variable->dimensions[field.order.along[2]];
  const NetcdfVariable* const coordinate = coordinate_of(file, *field.variable, dimension);
  const NetcdfVariable* const bounds =
      coordinate != nullptr ? file.find(*coordinate, file.text(*coordinate, "bounds")) : nullptr;
  if (bounds != nullptr && bounds->dimensions.size() == 2 && bounds->dimensions[0].id == dimension.id &&
      bounds->dimensions[1].length == 2) {
    const std::vector<double> ends = read_whole(file, *bounds, 2 * dimension.length).as_doubles();
    const double sign = counts_downwards(file, *coordinate) ? -1 : 1;
    const bool is_turned = z.size() > 1 && ends.size() > 3 && ends[0] == ends[3];  // each pair is in reverse order
    bool fit = true;
    for (std::size_t k = 0; k < z.size(); ++k) {
      const double low = sign * ends[2 * k + (is_turned ? 1 : 0)], high = sign * ends[2 * k + (is_turned ? 0 : 1)];
      if (k == 0) between.push_back(low);
      fit = fit && std::abs(between.back() - low) <= 1e-3 * std::abs(high - low);
      between.push_back(high);
    }
    if (fit) return between;
  }
  between.clear();
  for (std::size_t k = 0; k + 1 < z.size(); ++k) between.push_back((z[k] + z[k + 1]) / 2);
  const double half_first = z.size() > 1 ? (z[1] - z[0]) / 2 : 0.5,
               half_last = z.size() > 1 ? (z.back() - z[z.size() - 2]) / 2 : 0.5;
  between.insert(between.begin(), z.front() - half_first);
  between.push_back(z.back() + half_last);
  return between;
}

std::array<std::int64_t, 6> extent_of(const std::array<std::size_t, 3>& points) {
  std::array<std::int64_t, 6> extent{};
  for (std::size_t a = 0; a < 3; ++a) extent[2 * a + 1] = static_cast<std::int64_t>(points[a]) - 1;
  return extent;
}

io::ForeignArray read_field(Holdings& holdings, const NetcdfFile& file, const GridVariable& field, std::size_t step,
                            std::vector<std::string>& notes) {
  std::vector<std::size_t> first(field.variable->dimensions.size(), 0), counts;
  for (const NetcdfDimension& dimension : field.variable->dimensions) counts.push_back(dimension.length);
  const std::vector<std::size_t> indices = indices_of(field, step);
  for (std::size_t k = 0; k < indices.size(); ++k)
    first[field.order.steps[k]] = indices[k], counts[field.order.steps[k]] = 1;
  NetcdfValues values = read_values(file, *field.variable, first, counts);
  const auto note_blanks = [&](std::uint64_t count, const char* what) {
    if (count > 0) notes.push_back(fmt::format("{}: {} samples {} are blank", field.variable->path, count, what));
  };
  note_blanks(values.default_fills, "of NetCDF's default fill value");
  note_blanks(values.out_of_range, "outside its valid range");
  values.numbers.bytes =
      in_grid_order(std::move(values.numbers.bytes), io::size_of(values.numbers.type), counts, field.order.along);
  return hold_field_numbers(holdings, field.variable->path, std::move(values.numbers));
}

/// A grid with positions, but without fields.
struct PlacedGrid {
  io::ForeignPart part;
  bool has_cells = false;  ///< the fields are cell data
};

PlacedGrid place_grid(Holdings& holdings, const NetcdfFile& file, const GridOfVariables& grid, std::size_t step,
                      std::vector<std::string>& notes) {
  const GridVariable& first = grid.fields.front();
  PlacedGrid placed;
  io::ForeignPart& part = placed.part;
  std::array<std::size_t, 3> points{};
  for (std::size_t a = 0; a < 3; ++a) points[a] = first.variable->dimensions[first.order.along[a]].length;
  GridNumbers heights = coordinates_along(file, first, 2, notes);
  if (!grid.curved) {
    part.kind = io::ForeignPart::Kind::rectilinear;
    part.extent = extent_of(points);
    for (const std::size_t a : {0u, 1u})
      part.coordinates.push_back(hold_numbers(holdings, coordinates_along(file, first, a, notes)));
    part.coordinates.push_back(hold_numbers(holdings, std::move(heights)));
    return placed;
  }
  const std::vector<double> z = heights.as_doubles();
  CurvedGrid curved = curved_grid(file, *first.variable, first.order, indices_of(first, step), *grid.curved, z,
                                  levels_between(file, first, z), notes);
  part.kind = io::ForeignPart::Kind::structured;
  part.extent = extent_of(curved.points);
  part.points = hold_vector(holdings, {.type = NumberType::float64, .components = 3}, std::move(curved.positions));
  placed.has_cells = curved.has_cells;
  return placed;
}

bool is_in_degrees(const NetcdfFile& file, const GridOfVariables& grid) {
  if (grid.curved) return has_degrees(file, *grid.curved->x) || has_degrees(file, *grid.curved->y);
  const GridVariable& first = grid.fields.front();
  return std::any_of(first.order.along.begin(), first.order.along.end(), [&](std::size_t d) {
    const NetcdfVariable* const axis = coordinate_of(file, *first.variable, first.variable->dimensions[d]);
    return axis != nullptr && has_degrees(file, *axis);
  });
}

}  // namespace

bool holds_netcdf_grid(const std::filesystem::path& file) { return !grids_of(NetcdfFile(file)).empty(); }

io::ForeignContents read_netcdf(Holdings& holdings, const std::filesystem::path& file, const nlohmann::json& request) {
  allow_for(file);
  const NetcdfFile opened(file);
  io::ForeignContents contents;
  contents.format = "NetCDF";
  const std::vector<GridOfVariables> grids = grids_of(opened);
  if (grids.empty())
    throw scene::bad_input(fmt::format(
        "{}: none of its variables has three dimensions (not counting time); give a file with a three-dimensional grid",
        opened.source()));
  const GridOfVariables& grid = choose_grid(grids, request.value("field", ""), contents.notes);
  if (request.value("look", false)) {
    contents.parts.emplace_back().kind =
        grid.curved ? io::ForeignPart::Kind::structured : io::ForeignPart::Kind::rectilinear;
    return contents;
  }
  // The number of steps; variables that do not change with time exist at all steps.
  std::size_t steps = 0;
  const GridVariable* with_steps = nullptr;
  for (const GridVariable& field : grid.fields)
    if (steps_of(field) > steps) steps = steps_of(field), with_steps = &field;
  std::optional<std::size_t> requested;
  if (const auto step = request.find("time_step"); step != request.end()) requested = step->get<std::size_t>();
  contents.time_step = scene::chosen_step(requested, steps, opened.source());
  if (with_steps != nullptr) {
    note_steps(opened, *with_steps, contents.notes);
    scene::set_times(contents.time_step, times_of(opened, *with_steps));
  }
  PlacedGrid placed = place_grid(holdings, opened, grid, contents.time_step.step, contents.notes);
  std::size_t done = 0;
  for (const GridVariable& field : grid.fields) {
    const std::size_t its_step =
        std::min(static_cast<std::size_t>(contents.time_step.step), std::max<std::size_t>(steps_of(field), 1) - 1);
    (placed.has_cells ? placed.part.cell_fields : placed.part.point_fields)
        .push_back(read_field(holdings, opened, field, its_step, contents.notes));
    report_progress(static_cast<double>(++done) / static_cast<double>(grid.fields.size()));
  }
  contents.xy_in_degrees = is_in_degrees(opened, grid);
  if (contents.xy_in_degrees)
    contents.notes.emplace_back("longitude and latitude, in degrees, are used as x and y, not as places on a sphere");
  contents.parts.push_back(std::move(placed.part));
  return contents;
}

}  // namespace tessera::readers
