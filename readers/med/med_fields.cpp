// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <cstring>
#include <limits>

#include "readers/common/serve.hpp"
#include "readers/med/med_file.hpp"
#include "scene/error.hpp"

namespace tessera::readers {
namespace {

/// One field at one of its computation steps.
struct FieldAt {
  std::string name, mesh;
  med_field_type type = MED_FLOAT64;
  int components = 1;
  med_int step = MED_NO_DT, iteration = MED_NO_IT;
};

bool is_double(med_field_type type) { return type == MED_FLOAT64; }
bool is_float(med_field_type type) { return type == MED_FLOAT32; }
bool is_wide(med_field_type type) { return type == MED_INT64 || (type == MED_INT && sizeof(med_int) == 8); }

std::size_t size_of(med_field_type type) { return is_double(type) || is_wide(type) ? 8 : 4; }

double value_of(med_field_type type, const std::vector<unsigned char>& bytes, std::size_t k) {
  const auto as = [&](auto number) {
    std::memcpy(&number, bytes.data() + k * sizeof number, sizeof number);
    return static_cast<double>(number);
  };
  if (is_double(type)) return as(double{});
  if (is_float(type)) return as(float{});
  return is_wide(type) ? as(std::int64_t{}) : as(std::int32_t{});
}

/// Returns the nodes or cells, counted from 0, to which the values of a profile belong. All nodes or cells, in order,
/// if the profile has no name.
std::vector<std::size_t> places_of(const MedFile& file, const std::string& profile, std::size_t values,
                                   std::size_t count) {
  std::vector<std::size_t> places(values);
  if (profile.empty()) {
    for (std::size_t k = 0; k < values; ++k) places[k] = k;
  } else {
    file.require(MEDprofileSizeByName(file.id(), profile.c_str()) == static_cast<med_int>(values), "a profile");
    std::vector<med_int> numbers(values);
    file.require(MEDprofileRd(file.id(), profile.c_str(), numbers.data()) >= 0, "a profile");
    for (std::size_t k = 0; k < values; ++k) places[k] = static_cast<std::size_t>(numbers[k]) - 1;
  }
  file.require(std::all_of(places.begin(), places.end(), [&](std::size_t at) { return at < count; }) &&
                   (!profile.empty() || values == count),
               "a field whose number of values differs from that of the nodes or cells");
  return places;
}

enum class Found { none, some, at_points };
/// Writes the values that the file contains for `count` nodes, or for cells of one kind, to `out`.
Found read_values(const MedFile& file, const FieldAt& field, med_entity_type entity, med_geometry_type kind,
                  std::size_t count, double* out) {
  std::array<char, MED_NAME_SIZE + 1> profile{}, place{};
  const med_int profiles = MEDfieldnProfile(file.id(), field.name.c_str(), field.step, field.iteration, entity, kind,
                                            profile.data(), place.data());
  if (profiles <= 0 || count == 0) return Found::none;
  const auto components = static_cast<std::size_t>(field.components);
  for (int p = 1; p <= profiles; ++p) {
    med_int size = 0, points = 0;
    const med_int n =
        MEDfieldnValueWithProfile(file.id(), field.name.c_str(), field.step, field.iteration, entity, kind, p,
                                  MED_COMPACT_STMODE, profile.data(), &size, place.data(), &points);
    file.require(n >= 0, fmt::format("field '{}'", field.name));
    if (points > 1) return Found::at_points;
    const auto places = places_of(file, profile.data(), static_cast<std::size_t>(n), count);
    std::vector<unsigned char> bytes(places.size() * components * size_of(field.type));
    file.require(MEDfieldValueWithProfileRd(file.id(), field.name.c_str(), field.step, field.iteration, entity, kind,
                                            MED_COMPACT_STMODE, profile.data(), MED_FULL_INTERLACE, MED_ALL_CONSTITUENT,
                                            bytes.data()) >= 0,
                 fmt::format("field '{}'", field.name));
    for (std::size_t k = 0; k < places.size(); ++k)
      for (std::size_t c = 0; c < components; ++c)
        out[places[k] * components + c] = value_of(field.type, bytes, k * components + c);
  }
  return Found::some;
}

void add_field(const MedFile& file, const FieldAt& field, MedMesh& mesh, std::vector<std::string>& notes) {
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  const auto components = static_cast<std::size_t>(field.components);
  std::vector<double> of_nodes(mesh.block.positions.size() * components, nan);
  if (read_values(file, field, MED_NODE, MED_NO_GEOTYPE, mesh.block.positions.size(), of_nodes.data()) == Found::some)
    mesh.block.fields.push_back(
        cells::field_of_values(field.name, "double", scene::Association::point, field.components, std::move(of_nodes)));
  std::vector<double> of_cells(mesh.block.types.size() * components, nan);
  bool any = false;
  std::size_t first = 0;
  for (std::size_t k = 0; k < med_cell_kinds.size(); first += mesh.cells_of_kind[k++]) {
    const Found found = read_values(file, field, MED_CELL, med_cell_kinds[k].med, mesh.cells_of_kind[k],
                                    of_cells.data() + first * components);
    if (found == Found::at_points) {
      notes.push_back(fmt::format("field '{}' has several values in a cell and is left out", field.name));
      return;
    }
    any = any || found == Found::some;
  }
  if (any)
    mesh.block.fields.push_back(
        cells::field_of_values(field.name, "double", scene::Association::cell, field.components, std::move(of_cells)));
}

/// Returns the times of a field's steps; empty if a step has none.
std::vector<double> times_of(const MedFile& file, const FieldAt& field, std::size_t steps) {
  std::vector<double> times(steps);
  for (std::size_t k = 0; k < steps; ++k) {
    med_int step = 0, iteration = 0;
    if (MEDfieldComputingStepInfo(file.id(), field.name.c_str(), static_cast<int>(k) + 1, &step, &iteration,
                                  &times[k]) < 0)
      return {};
  }
  return times;
}

}  // namespace

void add_med_fields(const MedFile& file, std::optional<std::size_t> time_step, std::vector<MedMesh>& meshes,
                    std::vector<std::string>& notes, scene::TimeStepRead& read) {
  const med_int count = MEDnField(file.id());
  file.require(count >= 0 && count < 100000, "the number of fields");
  std::size_t most_steps = 0;
  std::vector<double> times;
  for (int f = 1; f <= count; ++f) {
    FieldAt field;
    field.components = MEDfieldnComponent(file.id(), f);
    file.require(field.components > 0 && field.components <= 1024, "a field");
    std::array<char, MED_NAME_SIZE + 1> name{}, mesh_name{};
    std::array<char, MED_SNAME_SIZE + 1> unit{};
    std::vector<char> names(static_cast<std::size_t>(field.components) * MED_SNAME_SIZE + 1), units(names.size());
    med_bool is_local = MED_FALSE;
    med_int steps = 0;
    file.require(MEDfieldInfo(file.id(), f, name.data(), mesh_name.data(), &is_local, &field.type, names.data(),
                              units.data(), unit.data(), &steps) >= 0,
                 "a field");
    field.name = name.data(), field.mesh = mesh_name.data();
    const auto known = static_cast<std::size_t>(std::max<med_int>(steps, 0));
    if (known > most_steps) {
      most_steps = known;
      times = times_of(file, field, known);
    }
    const std::size_t step = time_step.value_or(known == 0 ? 0 : known - 1);
    if (step >= known) continue;
    med_float time = 0;
    file.require(MEDfieldComputingStepInfo(file.id(), field.name.c_str(), static_cast<int>(step) + 1, &field.step,
                                           &field.iteration, &time) >= 0,
                 fmt::format("a time step of field '{}'", field.name));
    report_progress(static_cast<double>(f) / static_cast<double>(count));
    for (MedMesh& mesh : meshes)
      if (mesh.block.name == field.mesh) add_field(file, field, mesh, notes);
  }
  read = scene::chosen_step(time_step, most_steps, file.source());
  scene::set_times(read, std::move(times));
}

}  // namespace tessera::readers
