// SPDX-License-Identifier: BSD-3-Clause
#include "readers/vtk/hdf5/hdf5_grid.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <limits>
#include <nlohmann/json.hpp>
#include <optional>
#include <string_view>

#include "readers/common/serve.hpp"
#include "scene/error.hpp"

namespace tessera::readers {
namespace {

constexpr std::size_t most_components = 4;

/// An array whose axes are steps, then z, y and x, then components.
struct GridArray {
  const Hdf5Array* array = nullptr;
  std::size_t first = 0;       ///< index of the z axis in the array
  std::size_t components = 1;  ///< length of the axis after x, if there is one
  [[nodiscard]] std::array<std::size_t, 3> points() const {
    return {array->lengths[first + 2], array->lengths[first + 1], array->lengths[first]};
  }
  [[nodiscard]] std::size_t steps() const {
    double all = 1;
    for (std::size_t d = 0; d < first; ++d) all *= static_cast<double>(array->lengths[d]);
    return first == 0 ? 0 : static_cast<std::size_t>(std::min(all, 1e15));
  }
};

std::optional<GridArray> grid_array(const Hdf5Array& array) {
  const std::size_t rank = array.lengths.size();
  if (rank < 3 || std::find(array.lengths.begin(), array.lengths.end(), 0u) != array.lengths.end()) return std::nullopt;
  const std::size_t last = array.lengths.back();
  const bool has_components = rank > 3 && last <= most_components;
  return GridArray{&array, rank - (has_components ? 4 : 3), has_components ? last : 1};
}

/// Reads the numbers of one step, with the components of a sample interleaved. Missing values, as defined by NetCDF's
/// attributes, are NaN.
GridNumbers read_step(const Hdf5File& file, const GridArray& of, std::size_t step) {
  std::vector<std::size_t> first(of.array->lengths.size(), 0), counts = of.array->lengths;
  for (std::size_t d = of.first; d-- > 0;) {
    first[d] = step % of.array->lengths[d], counts[d] = 1;
    step /= of.array->lengths[d];
  }
  GridNumbers numbers = file.read(*of.array, first, counts);
  std::vector<double> missing = file.numbers_of(of.array->path.c_str(), "_FillValue");
  const std::vector<double> more = file.numbers_of(of.array->path.c_str(), "missing_value");
  missing.insert(missing.end(), more.begin(), more.end());
  if (missing.empty()) return numbers;
  std::vector<double> values = numbers.as_doubles();
  bool changes = false;
  for (double& value : values)
    if (std::find(missing.begin(), missing.end(), value) != missing.end())
      value = std::numeric_limits<double>::quiet_NaN(), changes = true;
  const bool is_narrow = io::size_of(numbers.type) <= 2 || numbers.type == NumberType::float32;
  return changes ? numbers_of(values, is_narrow ? NumberType::float32 : NumberType::float64) : numbers;
}

io::ForeignArray hold_step(Holdings& holdings, const Hdf5File& file, const GridArray& of, std::size_t step,
                           std::string name) {
  return hold_field_numbers(holdings, std::move(name), read_step(file, of, step), static_cast<int>(of.components));
}

/// Whether a requested field ("NAME", "point:NAME:0") is this array.
bool means(std::string_view field, std::string_view name) {
  if (field.starts_with("point:") && field != name) field.remove_prefix(6);
  return field == name || (field.starts_with(name) && field.substr(name.size()).starts_with(':'));
}

using SameSize = std::vector<GridArray>;

/// Chooses arrays of one size: those that include the field, otherwise the largest group, or the first of several
/// largest groups.
const SameSize& choose_arrays(const std::vector<SameSize>& sizes, const std::string& field,
                              std::vector<std::string>& notes) {
  const SameSize* chosen = &sizes.front();
  for (const SameSize& same : sizes)
    if (same.size() > chosen->size()) chosen = &same;
  for (const SameSize& same : sizes)
    if (std::any_of(same.begin(), same.end(), [&](const GridArray& a) { return means(field, a.array->path); }))
      chosen = &same;
  for (const SameSize& same : sizes)
    if (&same != chosen)
      notes.push_back(fmt::format("another grid, of {} samples, is {}{}: to show it, name it with `field`",
                                  fmt::join(same.front().points(), " x "), same.front().array->path,
                                  same.size() > 1 ? ", ..." : ""));
  return *chosen;
}

std::optional<std::size_t> requested_step(const nlohmann::json& request) {
  const auto step = request.find("time_step");
  return step == request.end() ? std::nullopt : std::optional(step->get<std::size_t>());
}

void set_unit_steps(const std::array<std::size_t, 3>& points, io::ForeignPart& part) {
  part.kind = io::ForeignPart::Kind::image;
  for (std::size_t a = 0; a < 3; ++a) part.extent[2 * a + 1] = static_cast<std::int64_t>(points[a]) - 1;
  part.spacing = {1, 1, 1};
  part.direction = {1, 0, 0, 0, 1, 0, 0, 0, 1};
}

}  // namespace

bool holds_arrays(const Hdf5File& file) {
  const std::vector<Hdf5Array> all = file.arrays();
  return std::any_of(all.begin(), all.end(), [](const Hdf5Array& array) { return grid_array(array).has_value(); });
}

io::ForeignContents read_arrays(Holdings& holdings, const Hdf5File& file, const std::string& source,
                                const nlohmann::json& request) {
  const std::vector<Hdf5Array> all = file.arrays();
  std::vector<SameSize> sizes;
  for (const Hdf5Array& array : all) {
    const std::optional<GridArray> as_grid = grid_array(array);
    if (!as_grid) continue;
    auto same = std::find_if(sizes.begin(), sizes.end(),
                             [&](const SameSize& s) { return s.front().points() == as_grid->points(); });
    if (same == sizes.end()) same = sizes.insert(sizes.end(), SameSize{});
    same->push_back(*as_grid);
  }
  if (sizes.empty())
    throw scene::bad_input(fmt::format(
        "{}: it is an HDF5 file without a three-dimensional array of numbers; give a file of a grid", source));
  io::ForeignContents contents;
  contents.format = "HDF5";
  const SameSize& chosen = choose_arrays(sizes, request.value("field", ""), contents.notes);
  io::ForeignPart part;
  set_unit_steps(chosen.front().points(), part);
  if (!request.value("look", false)) {
    const auto longest = std::max_element(chosen.begin(), chosen.end(),
                                          [](const GridArray& a, const GridArray& b) { return a.steps() < b.steps(); });
    contents.time_step = scene::chosen_step(requested_step(request), longest->steps(), source);
    if (longest->steps() > 1)
      contents.notes.push_back(
          fmt::format("time steps are counted along the first dimension of {}, whose dimensions are {}",
                      longest->array->path, fmt::join(longest->array->lengths, " x ")));
    std::size_t done = 0;
    for (const GridArray& array : chosen) {
      const std::size_t step =
          std::min<std::size_t>(contents.time_step.step, std::max<std::size_t>(array.steps(), 1) - 1);
      if (array.components > 1)
        contents.notes.push_back(fmt::format("the last dimension of {}, of size {}, is used for components",
                                             array.array->path, array.components));
      part.point_fields.push_back(hold_step(holdings, file, array, step, array.array->path));
      report_progress(static_cast<double>(++done) / static_cast<double>(chosen.size()));
    }
  }
  contents.parts.push_back(std::move(part));
  return contents;
}

namespace {

/// Returns the axes of an array of a VTKHDF image with these numbers of points or cells; no value if the array does not
/// fit.
std::optional<GridArray> image_array(const Hdf5Array& array, const std::array<std::size_t, 3>& points) {
  const std::size_t rank = array.lengths.size();
  for (const std::size_t components : {0u, 1u}) {
    if (rank < 3 + components || rank > 4 + components) continue;
    const GridArray as{&array, rank - 3 - components, components == 0 ? 1 : array.lengths.back()};
    if (as.points() == points && as.components <= 1000) return as;
  }
  return std::nullopt;
}

scene::Error wrong_image(const std::string& source, const char* what) {
  return scene::bad_input(fmt::format("{}: VTKHDF: {}; the file is damaged, write it again", source, what));
}

/// Reads extent, origin, spacing and direction.
io::ForeignPart image_of(const Hdf5File& file, const std::string& source) {
  io::ForeignPart part;
  set_unit_steps({1, 1, 1}, part);
  const std::vector<double> extent = file.numbers_of("VTKHDF", "WholeExtent"),
                            origin = file.numbers_of("VTKHDF", "Origin"),
                            spacing = file.numbers_of("VTKHDF", "Spacing"),
                            direction = file.numbers_of("VTKHDF", "Direction");
  if (extent.size() != 6) throw wrong_image(source, "its image has no WholeExtent of six numbers");
  for (std::size_t k = 0; k < 6; ++k) {
    if (!(std::abs(extent[k]) < 0x1p40)) throw wrong_image(source, "its WholeExtent is out of bounds");
    part.extent[k] = static_cast<std::int64_t>(extent[k]);
  }
  if (origin.size() == 3) std::copy(origin.begin(), origin.end(), part.origin.begin());
  if (spacing.size() == 3) std::copy(spacing.begin(), spacing.end(), part.spacing.begin());
  if (direction.size() == 9) std::copy(direction.begin(), direction.end(), part.direction.begin());
  for (std::size_t a = 0; a < 3; ++a)
    if (part.extent[2 * a + 1] < part.extent[2 * a]) throw wrong_image(source, "its WholeExtent is empty");
  return part;
}

/// Returns the index of a step along the first axis of an array. It is the number of the step unless the file states
/// another index.
std::size_t offset_of(const Hdf5File& file, const std::string& offsets, const std::string& name, std::size_t step) {
  for (const Hdf5Array& array : file.arrays(offsets))
    if (array.path == offsets + "/" + name && array.lengths.size() == 1 && step < array.lengths[0]) {
      const std::array<std::size_t, 1> first = {step}, one = {1};
      const double offset = file.read(array, first, one).as_doubles().front();
      return offset >= 0 ? static_cast<std::size_t>(offset) : step;
    }
  return step;
}

}  // namespace

io::ForeignContents read_vtk_hdf_image(Holdings& holdings, const Hdf5File& file, const std::string& source,
                                       const nlohmann::json& request) {
  io::ForeignContents contents;
  contents.format = "VTKHDF";
  io::ForeignPart part = image_of(file, source);
  const bool headers_only = request.value("look", false);
  const long steps = std::max(file.number_of("VTKHDF/Steps", "NSteps", 0), 0L);
  if (!headers_only)
    contents.time_step = scene::chosen_step(requested_step(request), static_cast<std::uint64_t>(steps), source);
  if (steps > 0 && !headers_only)
    for (const Hdf5Array& array : file.arrays("VTKHDF/Steps"))
      if (array.path == "VTKHDF/Steps/Values" && array.lengths.size() == 1 &&
          array.lengths[0] == static_cast<std::size_t>(steps))
        scene::set_times(contents.time_step,
                         file.read(array, std::array<std::size_t, 1>{0}, array.lengths).as_doubles());
  for (const bool of_points : {true, false}) {
    if (headers_only) break;
    const std::string kind = of_points ? "PointData" : "CellData", group = "VTKHDF/" + kind;
    std::array<std::size_t, 3> count{};
    for (std::size_t a = 0; a < 3; ++a) {
      const std::int64_t points = part.extent[2 * a + 1] - part.extent[2 * a] + 1;
      count[a] = static_cast<std::size_t>(of_points ? points : std::max<std::int64_t>(points - 1, 1));
    }
    const std::string active = file.text_of(group.c_str(), "Scalars");
    for (const Hdf5Array& array : file.arrays(group)) {
      const std::optional<GridArray> as = image_array(array, count);
      const std::string name = array.path.substr(group.size() + 1);
      if (!as) {
        contents.notes.push_back(fmt::format("{} is left out: its dimensions, {}, differ from the image's", name,
                                             fmt::join(array.lengths, " x ")));
        continue;
      }
      const std::size_t step =
          offset_of(file, "VTKHDF/Steps/" + kind + "Offsets", name, static_cast<std::size_t>(contents.time_step.step));
      if (as->first > 0 && step >= array.lengths[0]) throw wrong_image(source, "a time step is beyond its array's end");
      io::ForeignArray field = hold_step(holdings, file, *as, step, name);
      field.active = name == active;
      (of_points ? part.point_fields : part.cell_fields).push_back(std::move(field));
    }
  }
  contents.parts.push_back(std::move(part));
  return contents;
}

}  // namespace tessera::readers
