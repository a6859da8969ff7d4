// SPDX-License-Identifier: BSD-3-Clause
#include "readers/vtk/cgns_solutions.hpp"
// Included after the library, whose macros must come first.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string_view>

#include "scene/error.hpp"

namespace tessera::readers {
namespace {

/// Returns the names that a node below a zone or base lists for a step, 32 characters each. The lists are arrays whose
/// names end in "Pointers" and contain `word`.
std::vector<std::string> names_at_step(std::uint64_t step, std::string_view word) {
  std::vector<std::string> names;
  int arrays = 0;
  if (cg_narrays(&arrays) != CG_OK) return names;
  for (int a = 1; a <= arrays; ++a) {
    CgnsName name{};
    CGNS_ENUMT(DataType_t) type{};
    int dimensions = 0;
    std::array<cgsize_t, 12> size{};
    if (cg_array_info(a, name.data(), &type, &dimensions, size.data()) != CG_OK) continue;
    const std::string_view own = name.data();
    if (!own.ends_with("Pointers") || own.find(word) == std::string_view::npos || type != CGNS_ENUMV(Character) ||
        dimensions != 2 || size[0] < 1 || size[0] > 1024 || size[1] < 1 || size[1] > (1 << 24) ||
        step >= static_cast<std::uint64_t>(size[1]))
      continue;
    const auto length = static_cast<std::size_t>(size[0]);
    std::string all(length * static_cast<std::size_t>(size[1]), ' ');
    if (cg_array_read(a, all.data()) != CG_OK) continue;
    std::string at_step = all.substr(static_cast<std::size_t>(step) * length, length);
    at_step.resize(std::min(at_step.find('\0'), at_step.size()));
    at_step.resize(at_step.find_last_not_of(' ') + 1);
    names.push_back(std::move(at_step));
  }
  return names;
}

/// The arrays of a zone's values by name, in file order. Each has one number per point or cell.
struct Values {
  scene::Association association{};
  std::vector<std::pair<std::string, std::vector<double>>> arrays;

  [[nodiscard]] std::vector<double>* find(const std::string& name) {
    const auto found = std::ranges::find(arrays, name, &std::pair<std::string, std::vector<double>>::first);
    return found == arrays.end() ? nullptr : &found->second;
  }
  /// Returns the array of a name. If it is new, all values are missing.
  std::vector<double>& add(const std::string& name, std::size_t count) {
    if (std::vector<double>* const known = find(name)) return *known;
    arrays.emplace_back(name, std::vector<double>(count, std::numeric_limits<double>::quiet_NaN()));
    return arrays.back().second;
  }
};

/// Adds the arrays as fields. NameX, NameY and NameZ become the vector Name, as in VTK's reader.
void add_fields(Values values, cells::CellBlock& block) {
  for (auto& [name, numbers] : values.arrays) {
    if (numbers.empty()) continue;  // the array is already part of a vector
    const std::string stem = name.substr(0, name.size() - 1);
    const std::string_view last = std::string_view(name).substr(stem.size());
    std::vector<double>*const x = values.find(stem + "X"), *const y = values.find(stem + "Y"),
                              *const z = values.find(stem + "Z");
    if (stem.empty() || stem.ends_with('/') || (last != "X" && last != "Y" && last != "Z") || x == nullptr ||
        y == nullptr || z == nullptr) {
      block.fields.push_back(cells::field_of_values(name, "double", values.association, 1, std::move(numbers)));
      numbers.clear();
      continue;
    }
    std::vector<double> vectors;
    vectors.reserve(3 * x->size());
    for (std::size_t k = 0; k < x->size(); ++k) vectors.insert(vectors.end(), {(*x)[k], (*y)[k], (*z)[k]});
    x->clear(), y->clear(), z->clear();
    block.fields.push_back(cells::field_of_values(stem, "double", values.association, 3, std::move(vectors)));
  }
}

std::vector<std::string> field_names(const CgnsZone& zone, const CgnsSolution& solution) {
  int count = 0;
  require_cgns(cg_nfields(zone.file, zone.base, zone.zone, solution.number, &count), zone);
  std::vector<std::string> names;
  for (int k = 1; k <= count; ++k) {
    CgnsName name{};
    CGNS_ENUMT(DataType_t) type{};
    require_cgns(cg_field_info(zone.file, zone.base, zone.zone, solution.number, k, &type, name.data()), zone);
    names.emplace_back(name.data());
  }
  return names;
}

/// Returns the zone's points or cells for which a solution has values, in order; empty if it has values for all. Throws
/// Error(bad_input) for points or cells that the zone does not have.
std::vector<std::size_t> places_of(const CgnsZone& zone, const CgnsSolution& solution, bool of_cells) {
  const std::vector<cgsize_t> size = lengths(zone, of_cells);
  const std::size_t axes = size.size(), count = product(zone, of_cells);
  const bool is_range = solution.set == CGNS_ENUMV(PointRange);
  if (solution.in_set < 1 || static_cast<std::size_t>(solution.in_set) > std::max<std::size_t>(2, count))
    throw scene::bad_input(fmt::format("{}: solution '{}' has values at {} of {} {}; export the file again", zone.where,
                                       solution.name, solution.in_set, count, of_cells ? "cells" : "points"));
  std::vector<cgsize_t> indices(axes * static_cast<std::size_t>(solution.in_set));
  require_cgns(cg_sol_ptset_read(zone.file, zone.base, zone.zone, solution.number, indices.data()), zone);
  for (std::size_t k = 0; k < indices.size(); ++k)
    if (indices[k] < 1 || indices[k] > size[k % axes])
      throw scene::bad_input(
          fmt::format("{}: solution '{}' refers to index {}, which is not from 1 to {}; export the file again",
                      zone.where, solution.name, indices[k], size[k % axes]));
  std::vector<std::size_t> places;
  const auto add = [&](std::span<const cgsize_t> index) {
    std::size_t place = 0;
    for (std::size_t a = axes; a-- > 0;)
      place = place * static_cast<std::size_t>(size[a]) + static_cast<std::size_t>(index[a] - 1);
    places.push_back(place);
  };
  if (!is_range) {
    for (std::size_t k = 0; k < indices.size(); k += axes) add(std::span(indices).subspan(k, axes));
    return places;
  }
  const std::span<const cgsize_t> low = std::span(indices).first(axes), high = std::span(indices).last(axes);
  std::vector<cgsize_t> index(axes);
  std::size_t in_range = 1;
  for (std::size_t a = 0; a < axes; ++a)
    in_range *= static_cast<std::size_t>(std::max<cgsize_t>(high[a] - low[a] + 1, 0));
  for (std::size_t k = 0; k < in_range; ++k) {
    std::size_t rest = k;
    for (std::size_t a = 0; a < axes; ++a) {
      const auto length = static_cast<std::size_t>(high[a] - low[a] + 1);
      index[a] = low[a] + static_cast<cgsize_t>(rest % length);
      rest /= length;
    }
    add(index);
  }
  return places;
}

/// Reads a solution. If several solutions have a value, the first one is used.
void read_solution(const CgnsZone& zone, const CgnsSolution& solution, const CgnsNamesakes& namesakes, Values& values) {
  const bool of_cells = values.association == scene::Association::cell;
  const std::size_t count = product(zone, of_cells);
  if (count == 0) return;
  std::vector<std::size_t> places;
  std::vector<cgsize_t> first(zone.is_structured() ? 3 : 1, 1), last = lengths(zone, of_cells);
  if (solution.is_part()) {
    places = places_of(zone, solution, of_cells);
    first = {1}, last = {static_cast<cgsize_t>(places.size())};
    if (places.empty()) return;
  }
  for (const std::string& name : field_names(zone, solution)) {
    std::vector<double> numbers(solution.is_part() ? places.size() : count);
    require_cgns(cg_field_read(zone.file, zone.base, zone.zone, solution.number, name.c_str(), CGNS_ENUMV(RealDouble),
                               first.data(), last.data(), numbers.data()),
                 zone);
    const bool is_namesake = namesakes.contains({solution.location, name});
    std::vector<double>& of_zone = values.add(is_namesake ? fmt::format("{}/{}", solution.name, name) : name, count);
    for (std::size_t k = 0; k < numbers.size(); ++k) {
      double& value = of_zone[solution.is_part() ? places[k] : k];
      if (std::isnan(value)) value = numbers[k];
    }
  }
}

}  // namespace

bool is_mesh(const CgnsZone& zone) {
  return zone.dimensions == 3 && (zone.is_structured() || zone.type == CGNS_ENUMV(Unstructured));
}

std::vector<cgsize_t> lengths(const CgnsZone& zone, bool of_cells) {
  const std::size_t n = zone.is_structured() ? 3 : 1, first = of_cells ? n : 0;
  return {zone.size.begin() + static_cast<std::ptrdiff_t>(first),
          zone.size.begin() + static_cast<std::ptrdiff_t>(first + n)};
}

std::size_t product(const CgnsZone& zone, bool of_cells) {
  double wide = 1;
  std::size_t count = 1;
  for (const cgsize_t n : lengths(zone, of_cells)) {
    wide *= static_cast<double>(n);
    if (n < 0 || wide > std::numeric_limits<std::uint32_t>::max())
      throw scene::bad_input(
          fmt::format("{}: it has an impossible size, or 2^32 points or more; split it, or export "
                      "the file again",
                      zone.where));
    count *= static_cast<std::size_t>(n);
  }
  return count;
}

std::vector<std::string> zone_names_at_step(const CgnsZone& zone, std::uint64_t step, std::string_view word) {
  CgnsName name{};
  if (cg_ziter_read(zone.file, zone.base, zone.zone, name.data()) != CG_OK ||
      cg_goto(zone.file, zone.base, "Zone_t", zone.zone, "ZoneIterativeData_t", 1, "end") != CG_OK)
    return {};
  return names_at_step(step, word);
}

std::vector<CgnsSolution> solutions_of(const CgnsZone& zone, std::uint64_t step) {
  const std::vector<std::string> names = zone_names_at_step(zone, step, "Solution");
  int count = 0;
  require_cgns(cg_nsols(zone.file, zone.base, zone.zone, &count), zone);
  std::vector<CgnsSolution> solutions;
  for (int k = 1; k <= count; ++k) {
    CgnsName name{};
    CgnsSolution solution{.number = k};
    require_cgns(cg_sol_info(zone.file, zone.base, zone.zone, k, name.data(), &solution.location), zone);
    if (!names.empty() && std::ranges::count(names, name.data()) == 0) continue;
    solution.name = name.data();
    if (cg_sol_ptset_info(zone.file, zone.base, zone.zone, k, &solution.set, &solution.in_set) != CG_OK)
      solution.set = CGNS_ENUMV(PointSetTypeNull);
    solutions.push_back(std::move(solution));
  }
  return solutions;
}

CgnsNamesakes namesakes_of(std::span<const CgnsZone> zones, std::uint64_t step) {
  CgnsNamesakes namesakes;
  for (const CgnsZone& zone : zones) {
    CgnsNamesakes seen;
    if (!is_mesh(zone)) continue;
    for (const CgnsSolution& solution : solutions_of(zone, step))
      if (!solution.is_part())
        for (const std::string& name : field_names(zone, solution))
          if (!seen.emplace(solution.location, name).second) namesakes.emplace(solution.location, name);
  }
  return namesakes;
}

void set_fields(const CgnsZone& zone, std::uint64_t step, const CgnsNamesakes& namesakes, bool has_cell_values,
                cells::CellBlock& block, std::vector<std::string>& notes) {
  Values points{scene::Association::point, {}}, cells{scene::Association::cell, {}};
  for (const CgnsSolution& solution : solutions_of(zone, step)) {
    const bool is_vertex = solution.location == CGNS_ENUMV(Vertex),
               is_cell = solution.location == CGNS_ENUMV(CellCenter);
    // If a solution covers parts of a zone, cells are identified by the numbers of their elements.
    const bool is_known =
        !solution.is_part() || ((solution.set == CGNS_ENUMV(PointRange) || solution.set == CGNS_ENUMV(PointList)) &&
                                (is_vertex || zone.is_structured() || is_plain(zone)));
    if (is_known && is_vertex)
      read_solution(zone, solution, namesakes, points);
    else if (is_known && is_cell && has_cell_values)
      read_solution(zone, solution, namesakes, cells);
    else
      notes.push_back(fmt::format("'{}' of {} is left out: it has values {}", solution.name, zone.name,
                                  !is_known ? "for only some of the points or cells"
                                  : is_cell ? "for another number of cells"
                                            : "of faces or edges"));
  }
  add_fields(std::move(points), block);
  add_fields(std::move(cells), block);
}

}  // namespace tessera::readers
