// SPDX-License-Identifier: BSD-3-Clause
#include "readers/vtk/cgns_solutions.hpp"
// Included after the library, whose macros must come first.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>
#include <numbers>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "cells/part_range.hpp"
#include "readers/common/readers.hpp"
#include "readers/common/serve.hpp"
#include "readers/vtk/cgns_zones.hpp"
#include "scene/error.hpp"

namespace tessera::readers {
namespace {

/// An open file.
class CgnsFile {
 public:
  explicit CgnsFile(const std::filesystem::path& file) : is_open_(cg_open(file.c_str(), CG_MODE_READ, &id_) == CG_OK) {}
  ~CgnsFile() {
    if (is_open_) cg_close(id_);
  }
  CgnsFile(const CgnsFile&) = delete;
  CgnsFile& operator=(const CgnsFile&) = delete;

  [[nodiscard]] bool is_open() const { return is_open_; }
  [[nodiscard]] int id() const { return id_; }

 private:
  int id_ = 0;
  bool is_open_;
};

std::vector<CgnsZone> zones_of(const CgnsFile& file, const std::string& source) {
  std::vector<CgnsZone> zones;
  CgnsZone about{.file = file.id(), .where = source};
  int bases = 0;
  require_cgns(cg_nbases(file.id(), &bases), about);
  for (int base = 1; base <= bases; ++base) {
    CgnsName base_name{};
    int dimensions = 0, physical = 0, count = 0;
    require_cgns(cg_base_read(file.id(), base, base_name.data(), &dimensions, &physical), about);
    require_cgns(cg_nzones(file.id(), base, &count), about);
    for (int k = 1; k <= count; ++k) {
      CgnsZone zone{.file = file.id(), .base = base, .zone = k, .where = source, .dimensions = dimensions};
      CgnsName name{};
      require_cgns(cg_zone_read(file.id(), base, k, name.data(), zone.size.data()), zone);
      require_cgns(cg_zone_type(file.id(), base, k, &zone.type), zone);
      zone.name = fmt::format("{}/{}", base_name.data(), name.data());
      zone.where = fmt::format("{}: {}", source, zone.name);
      zones.push_back(std::move(zone));
    }
  }
  return zones;
}

/// Returns the coordinate grid of a zone at a step.
int grid_at_step(const CgnsZone& zone, std::uint64_t step) {
  const std::vector<std::string> names = zone_names_at_step(zone, step, "GridCoordinates");
  int count = 0;
  require_cgns(cg_ngrids(zone.file, zone.base, zone.zone, &count), zone);
  for (int grid = 1; grid <= count; ++grid) {
    CgnsName name{};
    require_cgns(cg_grid_read(zone.file, zone.base, zone.zone, grid, name.data()), zone);
    if (names.empty() ? std::string_view(name.data()) == "GridCoordinates" : names[0] == name.data()) return grid;
  }
  throw scene::bad_input(fmt::format("{}: it has no coordinates{}; export the file again", zone.where,
                                     names.empty() ? "" : fmt::format(" named '{}' for time step {}", names[0], step)));
}

/// Names of a zone's coordinates, in the order of a point's components.
constexpr std::array<std::string_view, 3> cartesian_axes = {"CoordinateX", "CoordinateY", "CoordinateZ"};
constexpr std::array<std::string_view, 3> cylinder_axes = {"CoordinateR", "CoordinateTheta", "CoordinateZ"};

bool has_cylinder_axes(const CgnsZone& zone) {
  int count = 0;
  if (cg_ncoords(zone.file, zone.base, zone.zone, &count) != CG_OK) return false;
  for (int k = 1; k <= count; ++k) {
    CgnsName name{};
    CGNS_ENUMT(DataType_t) type{};
    if (cg_coord_info(zone.file, zone.base, zone.zone, k, &type, name.data()) == CG_OK &&
        cylinder_axes[1] == name.data())
      return true;
  }
  return false;
}

/// Whether angles are in degrees, according to the nearest node that states units; otherwise they are in radians.
bool has_degrees(const CgnsZone& zone, int grid, int array) {
  const auto at = [&](int deep) {
    if (deep == 3)
      return cg_goto(zone.file, zone.base, "Zone_t", zone.zone, "GridCoordinates_t", grid, "DataArray_t", array, "end");
    if (deep == 2) return cg_goto(zone.file, zone.base, "Zone_t", zone.zone, "GridCoordinates_t", grid, "end");
    return deep == 1 ? cg_goto(zone.file, zone.base, "Zone_t", zone.zone, "end") : cg_goto(zone.file, zone.base, "end");
  };
  for (int deep = 3; deep >= 0; --deep) {
    CGNS_ENUMT(MassUnits_t) mass{};
    CGNS_ENUMT(LengthUnits_t) length{};
    CGNS_ENUMT(TimeUnits_t) time{};
    CGNS_ENUMT(TemperatureUnits_t) temperature{};
    CGNS_ENUMT(AngleUnits_t) angle{};
    if (at(deep) == CG_OK && cg_units_read(&mass, &length, &time, &temperature, &angle) == CG_OK)
      return angle == CGNS_ENUMV(Degree);
  }
  return false;
}

void set_positions(const CgnsZone& zone, std::uint64_t step, cells::CellBlock& block) {
  const int grid = grid_at_step(zone, step);
  const std::size_t points = product(zone, false);
  require_cgns(cg_goto(zone.file, zone.base, "Zone_t", zone.zone, "GridCoordinates_t", grid, "end"), zone);
  std::array<int, 6> rind{};
  const bool has_rind = cg_rind_read(rind.data()) == CG_OK && std::ranges::any_of(rind, [](int n) { return n != 0; });
  int arrays = 0;
  require_cgns(cg_narrays(&arrays), zone);
  block.positions.assign(points, glm::dvec3(0));
  std::vector<double> values(points);
  const auto& axes = has_cylinder_axes(zone) ? cylinder_axes : cartesian_axes;
  int found = 0, angles = 0;
  for (int a = 1; a <= arrays; ++a) {
    CgnsName name{};
    CGNS_ENUMT(DataType_t) type{};
    int dimensions = 0;
    std::array<cgsize_t, 12> size{};
    require_cgns(cg_array_info(a, name.data(), &type, &dimensions, size.data()), zone);
    const auto axis = std::ranges::find(axes, name.data()) - axes.begin();
    if (axis == 3) continue;
    std::size_t count = 1;
    for (int d = 0; d < dimensions; ++d) count *= static_cast<std::size_t>(size[static_cast<std::size_t>(d)]);
    if (has_rind || count != points)
      throw scene::bad_input(fmt::format("{}: its coordinates have {} numbers for {} points{}; export it without rind",
                                         zone.where, count, points, has_rind ? ", with rind" : ""));
    require_cgns(cg_array_read_as(a, CGNS_ENUMV(RealDouble), values.data()), zone);
    for (std::size_t v = 0; v < points; ++v) block.positions[v][static_cast<int>(axis)] = values[v];
    ++found;
    if (axis == 1) angles = a;
  }
  if (found != 3)
    throw scene::bad_input(
        fmt::format("{}: it has {} of {}, {} and {}; other coordinates are not supported, export CoordinateX, "
                    "CoordinateY and CoordinateZ",
                    zone.where, found, axes[0], axes[1], axes[2]));
  if (axes == cartesian_axes) return;
  const double unit = has_degrees(zone, grid, angles) ? std::numbers::pi / 180 : 1;
  for (glm::dvec3& p : block.positions) p = {p[0] * std::cos(unit * p[1]), p[0] * std::sin(unit * p[1]), p[2]};
}

/// No value for a zone without three-dimensional cells.
std::optional<io::ForeignPart> part_of(Holdings& holdings, const CgnsZone& zone, std::uint64_t step,
                                       const CgnsNamesakes& namesakes, std::vector<std::string>& notes) {
  cells::CellBlock block;
  block.name = zone.name;
  bool has_cell_values = true;
  if (!zone.is_structured()) {
    set_cells(zone, block);
    if (block.types.empty()) return std::nullopt;
    has_cell_values = block.types.size() == product(zone, true);
  }
  set_positions(zone, step, block);
  set_fields(zone, step, namesakes, has_cell_values, block, notes);
  io::ForeignPart part = hold_block(holdings, std::move(block));
  if (!zone.is_structured()) return part;
  part.kind = io::ForeignPart::Kind::structured;
  for (std::size_t a = 0; a < 3; ++a) part.extent[2 * a + 1] = zone.size[a] - 1;
  for (auto* const array : {&part.types, &part.offsets, &part.connectivity}) {
    holdings.drop((*array)->number);
    array->reset();
  }
  return part;
}

/// The steps of the first base with iterative data.
struct CgnsSteps {
  std::uint64_t count = 0;
  std::vector<double> times;
};

CgnsSteps steps_of(std::span<const CgnsZone> zones) {
  for (const CgnsZone& zone : zones) {
    CgnsName name{};
    int steps = 0;
    if (cg_biter_read(zone.file, zone.base, name.data(), &steps) != CG_OK || steps <= 0) continue;
    CgnsSteps found{static_cast<std::uint64_t>(steps), {}};
    int arrays = 0;
    if (cg_goto(zone.file, zone.base, "BaseIterativeData_t", 1, "end") == CG_OK && cg_narrays(&arrays) == CG_OK)
      for (int k = 1; k <= arrays; ++k) {
        CGNS_ENUMT(DataType_t) type{};
        int dimensions = 0;
        std::array<cgsize_t, 12> lengths{};
        if (cg_array_info(k, name.data(), &type, &dimensions, lengths.data()) != CG_OK ||
            std::string_view(name.data()) != "TimeValues" || dimensions != 1 || lengths[0] != steps)
          continue;
        found.times.resize(found.count);
        if (cg_array_read_as(k, CGNS_ENUMV(RealDouble), found.times.data()) != CG_OK) found.times.clear();
      }
    return found;
  }
  return {};
}

}  // namespace

std::optional<io::ForeignContents> read_cgns_zones(Holdings& holdings, const std::filesystem::path& file,
                                                   const nlohmann::json& request) {
  const std::string source = file.string();
  const CgnsFile opened(file);
  if (!opened.is_open()) return std::nullopt;
  const std::vector<CgnsZone> zones = zones_of(opened, source);
  std::optional<std::size_t> requested;
  if (const auto step = request.find("time_step"); step != request.end()) requested = step->get<std::size_t>();
  CgnsSteps steps = steps_of(zones);
  const std::uint64_t step = requested ? *requested : std::max<std::uint64_t>(steps.count, 1) - 1;
  const CgnsNamesakes namesakes = namesakes_of(zones, step);
  const auto needs_this = [&](const CgnsZone& zone) {
    return is_mesh(zone) && ((!zone.is_structured() && !is_plain(zone)) || has_cylinder_axes(zone) ||
                             std::ranges::any_of(solutions_of(zone, step), &CgnsSolution::is_part));
  };
  if (namesakes.empty() && std::ranges::none_of(zones, needs_this)) return std::nullopt;
  io::ForeignContents contents;
  contents.format = "CGNS";
  contents.time_step = scene::chosen_step(requested, steps.count, source);
  scene::set_times(contents.time_step, std::move(steps.times));
  const int part = request.value("part", 0), parts = request.value("parts", 1);
  const std::uint64_t first = cells::first_of_part(zones.size(), part, parts);
  const std::uint64_t last = cells::first_of_part(zones.size(), part + 1, parts);
  for (std::uint64_t k = first; k < last; ++k) {
    if (!is_mesh(zones[k])) continue;
    report_progress(static_cast<double>(k - first) / static_cast<double>(last - first));
    if (auto read = part_of(holdings, zones[k], contents.time_step.step, namesakes, contents.notes))
      contents.parts.push_back(std::move(*read));
  }
  if (contents.parts.empty() && parts == 1)
    throw scene::bad_input(
        fmt::format("{}: its zones have no cells of three dimensions; give a file with a volume mesh", source));
  return contents;
}

}  // namespace tessera::readers
