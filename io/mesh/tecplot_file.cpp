// SPDX-License-Identifier: BSD-3-Clause
#include "io/mesh/tecplot_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>
#include <memory>
#include <set>
#include <utility>

#include "io/files/whole_file.hpp"
#include "io/mesh/mesh_formats.hpp"
#include "io/mesh/tecplot_numbers.hpp"
#include "io/text/scanner.hpp"
#include "scene/error.hpp"
#include "tessera/cell_type.hpp"
#include "tessera/program/text.hpp"

namespace tessera::io {
namespace {

/// The coordinate letter with which a name begins: "X", "x [m]", "CoordinateX"; 0 for others.
char tecplot_axis(std::string_view name) {
  constexpr std::string_view words = "Coordinate";
  if (name.starts_with(words)) name.remove_prefix(words.size());
  const std::size_t first = name.find_first_not_of(' ');
  if (first == std::string_view::npos) return 0;
  name.remove_prefix(first);
  const char letter = static_cast<char>(name[0] | 0x20);
  if (letter < 'x' || letter > 'z') return 0;
  return name.size() == 1 || name[1] == ' ' || name[1] == '(' || name[1] == '[' || name[1] == ',' ? letter : '\0';
}

std::array<std::size_t, 3> tecplot_coordinates(const TecplotHeader& header, const std::string& source) {
  std::array<std::size_t, 3> axes{};
  std::array<int, 3> found{};
  for (std::size_t v = header.variables.size(); v-- > 0;)
    if (const char axis = tecplot_axis(header.variables[v]); axis != 0) {
      axes[static_cast<std::size_t>(axis - 'x')] = v;
      found[static_cast<std::size_t>(axis - 'x')] = 1;
    }
  if (found[0] + found[1] + found[2] == 3) return axes;
  if (header.variables.size() < 3)
    throw scene::bad_input(fmt::format(
        "{}: it has {} variables, but a volume needs the coordinates X, Y and Z; give a file with all three", source,
        header.variables.size()));
  return {0, 1, 2};
}

bool has_tecplot_cells(const TecplotZone& zone) {
  return zone.type == TecplotZoneType::ordered ? zone.i > 1 && zone.j > 1 && zone.k > 1
                                               : zone.type != TecplotZoneType::lines_or_faces;
}

/// Returns the time of a zone that belongs to a single step; no value for other zones.
std::optional<double> time_of(const TecplotZone& zone) { return zone.strand == 0 ? std::nullopt : zone.time; }

/// Returns the solution times of zones with cells, sorted.
std::vector<double> times_of(const TecplotHeader& header) {
  std::set<double> times;
  for (const TecplotZone& zone : header.zones)
    if (has_tecplot_cells(zone) && time_of(zone)) times.insert(*time_of(zone));
  return {times.begin(), times.end()};
}

scene::TimeStepRead steps_in(const TecplotHeader& header, std::optional<std::size_t> requested,
                             const std::string& source) {
  std::vector<double> times = times_of(header);
  scene::TimeStepRead read = scene::chosen_step(requested, times.size(), source);
  scene::set_times(read, std::move(times));
  return read;
}

/// Returns the zones of a step. A strand without a zone at this time contributes its last zone before this time.
std::vector<std::size_t> zones_at(const TecplotHeader& header, bool has_steps, double time) {
  std::vector<std::size_t> zones;
  std::map<std::int64_t, double> latest;  // per strand
  for (const TecplotZone& zone : header.zones)
    if (const double own = time_of(zone).value_or(time); time_of(zone) && zone.strand && own <= time) {
      const auto at = latest.try_emplace(*zone.strand, own).first;
      at->second = std::max(at->second, own);
    }
  for (std::size_t z = 0; z < header.zones.size(); ++z) {
    const TecplotZone& zone = header.zones[z];
    if (!has_tecplot_cells(zone)) continue;
    const double own = time_of(zone).value_or(time);
    const bool is_latest = zone.strand && latest.contains(*zone.strand) && latest.at(*zone.strand) == own;
    if (!has_steps || own == time || is_latest) zones.push_back(z);
  }
  return zones;
}

/// Reads zones on demand, and keeps them for the zones that share their values.
class TecplotZones {
 public:
  TecplotZones(std::string_view text, const TecplotHeader& header, const std::string& source)
      : text_(text), header_(header), source_(source) {}

  const TecplotNumbers& numbers(std::size_t zone) {
    auto& read = read_[zone];
    if (!read) read = std::make_unique<TecplotNumbers>(read_tecplot_numbers(text_, header_.zones[zone], source_));
    return *read;
  }

  /// Returns the zone that stores the values of a variable of `zone`: the zone itself, or an earlier one.
  [[nodiscard]] std::size_t owner_of(std::size_t zone, std::size_t variable) const {
    for (;;) {
      const auto& shared = header_.zones[zone].shared_from;
      const auto from = shared.find(variable);
      if (from == shared.end()) return zone;
      zone = from->second;
    }
  }

  [[nodiscard]] std::size_t owner_of_elements(std::size_t zone) const {
    while (header_.zones[zone].connectivity_from) zone = *header_.zones[zone].connectivity_from;
    return zone;
  }

  /// Returns the values per node or element. Empty if the zone has no values of this variable.
  const std::vector<double>& values(std::size_t zone, std::size_t variable) {
    const TecplotZone& own = header_.zones[zone];
    const std::size_t owner = owner_of(zone, variable);
    const std::vector<double>& values = numbers(owner).values[variable];
    const std::size_t wanted = header_.zones[owner].of_cells[variable] ? own.elements : own.nodes;
    if (!own.is_passive[variable] && !header_.zones[owner].is_passive[variable] && values.size() != wanted)
      refuse(own, fmt::format("the zone shares {} values of {} with zone {}, but needs {}; export the file again",
                              values.size(), quote(header_.variables[variable]), owner + 1, wanted));
    return values;
  }

  [[noreturn]] void refuse(const TecplotZone& zone, const std::string& what) const {
    fail_at(text_, zone.record_at, source_, what);
  }

 private:
  std::string_view text_;
  const TecplotHeader& header_;
  const std::string& source_;
  std::map<std::size_t, std::unique_ptr<TecplotNumbers>> read_;
};

void add_tecplot_cell(cells::CellBlock& block, CellType type, std::initializer_list<std::size_t> nodes) {
  block.types.push_back(vtk_number(type));
  for (const std::size_t node : nodes) block.connectivity.push_back(static_cast<std::uint32_t>(node));
  block.offsets.push_back(block.connectivity.size());
}

/// Adds a brick. Bricks with repeated nodes are wedges, pyramids and tetrahedra, as the guide defines them.
void add_brick(cells::CellBlock& block, const std::array<std::size_t, 8>& n) {
  const bool is_top_point = n[4] == n[5] && n[5] == n[6] && n[6] == n[7];
  if (n[2] == n[3] && is_top_point)
    add_tecplot_cell(block, CellType::tetra, {n[0], n[1], n[2], n[4]});
  else if (is_top_point)
    add_tecplot_cell(block, CellType::pyramid, {n[0], n[1], n[2], n[3], n[4]});
  else if (n[2] == n[3] && n[6] == n[7])
    add_tecplot_cell(block, CellType::wedge, {n[0], n[1], n[2], n[4], n[5], n[6]});
  else
    add_tecplot_cell(block, CellType::hexahedron, {n[0], n[1], n[2], n[3], n[4], n[5], n[6], n[7]});
}

void add_ordered(const TecplotZone& zone, cells::CellBlock& block) {
  const std::size_t row = zone.i, layer = zone.i * zone.j;
  for (std::size_t k = 0; k + 1 < zone.k; ++k)
    for (std::size_t j = 0; j + 1 < zone.j; ++j)
      for (std::size_t i = 0; i + 1 < zone.i; ++i) {
        const std::size_t p = i + j * row + k * layer;
        add_tecplot_cell(
            block, CellType::hexahedron,
            {p, p + 1, p + row + 1, p + row, p + layer, p + layer + 1, p + layer + row + 1, p + layer + row});
      }
}

/// Adds polyhedra. The faces of a polyhedron are those that have it on their left or right.
void add_polyhedra(const TecplotZone& zone, const TecplotNumbers& numbers, cells::CellBlock& block) {
  std::vector<std::vector<std::size_t>> faces_of(zone.elements);
  std::vector<std::size_t> starts{0};
  for (std::size_t f = 0; f < numbers.face_sizes.size(); ++f) {
    starts.push_back(starts.back() + numbers.face_sizes[f]);
    for (const std::size_t element : {numbers.left[f], numbers.right[f]})
      if (element > 0) faces_of[element - 1].push_back(f);
  }
  for (const std::vector<std::size_t>& faces : faces_of) {
    block.face_locations.push_back(static_cast<std::int64_t>(block.faces.size()));
    block.faces.push_back(static_cast<std::uint32_t>(faces.size()));
    std::set<std::size_t> nodes;
    for (const std::size_t f : faces) {
      block.faces.push_back(static_cast<std::uint32_t>(starts[f + 1] - starts[f]));
      for (std::size_t n = starts[f]; n < starts[f + 1]; ++n) {
        block.faces.push_back(static_cast<std::uint32_t>(numbers.face_nodes[n] - 1));
        nodes.insert(numbers.face_nodes[n] - 1);
      }
    }
    block.types.push_back(vtk_number(CellType::polyhedron));
    block.connectivity.insert(block.connectivity.end(), nodes.begin(), nodes.end());
    block.offsets.push_back(block.connectivity.size());
  }
}

void add_cells(const TecplotZone& zone, const TecplotNumbers& numbers, cells::CellBlock& block,
               const TecplotZones& zones) {
  block.offsets.assign(1, 0);
  if (zone.type == TecplotZoneType::ordered) return add_ordered(zone, block);
  for (const auto* const nodes : {&numbers.connectivity, &numbers.face_nodes})
    for (const std::size_t node : *nodes)
      if (node < 1 || node > block.positions.size())
        zones.refuse(
            zone,
            fmt::format("an element uses node {}, but the zone has {} nodes; nodes count from 1, export the file again",
                        node, block.positions.size()));
  if (zone.type == TecplotZoneType::polyhedra) return add_polyhedra(zone, numbers, block);
  const std::vector<std::size_t>& all = numbers.connectivity;
  if (zone.type == TecplotZoneType::tetrahedra) {
    for (std::size_t k = 0; k + 4 <= all.size(); k += 4)
      add_tecplot_cell(block, CellType::tetra, {all[k] - 1, all[k + 1] - 1, all[k + 2] - 1, all[k + 3] - 1});
    return;
  }
  for (std::size_t k = 0; k + 8 <= all.size(); k += 8) {
    std::array<std::size_t, 8> nodes{};
    for (std::size_t n = 0; n < 8; ++n) nodes[n] = all[k + n] - 1;
    add_brick(block, nodes);
  }
}

cells::CellBlock block_of_zone(const TecplotHeader& header, std::size_t z, const std::array<std::size_t, 3>& axes,
                               TecplotZones& zones) {
  const TecplotZone& zone = header.zones[z];
  cells::CellBlock block;
  block.name = zone.name.empty() ? fmt::format("zone {}", z + 1) : zone.name;
  block.positions.assign(zone.nodes, glm::dvec3(0));
  for (std::size_t a = 0; a < 3; ++a) {
    const std::vector<double>& values = zones.values(z, axes[a]);
    if (values.size() != zone.nodes)
      zones.refuse(zone, fmt::format("the coordinate {} is not stored at the zone's nodes; write it as NODAL",
                                     quote(header.variables[axes[a]])));
    for (std::size_t n = 0; n < zone.nodes; ++n) block.positions[n][static_cast<int>(a)] = values[n];
  }
  const std::size_t owner = zones.owner_of_elements(z);
  if (header.zones[owner].elements != zone.elements || header.zones[owner].type != zone.type)
    zones.refuse(zone, fmt::format("the zone has other elements than zone {}, with which it shares them; export the "
                                   "file again",
                                   owner + 1));
  add_cells(zone, zones.numbers(owner), block, zones);
  for (std::size_t v = 0; v < header.variables.size(); ++v) {
    if (std::ranges::count(axes, v) > 0) continue;
    std::vector<double> values = zones.values(z, v);
    if (values.empty()) continue;
    const bool of_cells = header.zones[zones.owner_of(z, v)].of_cells[v];
    block.fields.push_back(cells::field_of_values(header.variables[v], "double",
                                                  of_cells ? scene::Association::cell : scene::Association::point, 1,
                                                  std::move(values)));
  }
  return block;
}

}  // namespace

TecplotMesh parse_tecplot(std::string_view text, const std::string& source, std::optional<std::size_t> time_step) {
  const TecplotHeader header = parse_tecplot_header(text, source);
  if (header.zones.empty())
    throw scene::bad_input(fmt::format("{}: it has no ZONE; check that it is a text of Tecplot's", source));
  const auto with_cells = static_cast<std::size_t>(std::ranges::count_if(header.zones, has_tecplot_cells));
  if (with_cells == 0)
    throw scene::bad_input(
        fmt::format("{}: its {} zones contain no volume cells; give one with bricks, tetrahedra or three dimensions",
                    source, header.zones.size()));
  const std::array<std::size_t, 3> axes = tecplot_coordinates(header, source);
  TecplotMesh mesh;
  mesh.time_step = steps_in(header, time_step, source);
  if (with_cells < header.zones.size())
    mesh.notes.push_back(fmt::format("{} of {} zones are lines or faces, which are left out",
                                     header.zones.size() - with_cells, header.zones.size()));
  TecplotZones zones(text, header, source);
  const std::vector<double> times = times_of(header);
  const double time = times.empty() ? 0 : times[mesh.time_step.step];
  for (const std::size_t z : zones_at(header, !times.empty(), time))
    mesh.blocks.push_back(block_of_zone(header, z, axes, zones));
  return mesh;
}

cells::MeshBlocks read_tecplot(const InputFile& file, const MeshOptions& options) {
  TecplotMesh read = parse_tecplot(WholeFile(file.path).text(), file.name, options.time_step);
  cells::MeshBlocks mesh{std::move(read.blocks), std::move(read.notes), "Tecplot (text)"};
  mesh.time_step = std::move(read.time_step);
  return mesh;
}

scene::TimeStepRead tecplot_time_steps(const InputFile& file, const MeshOptions& options) {
  return steps_in(parse_tecplot_header(WholeFile(file.path).text(), file.name), options.time_step, file.name);
}

}  // namespace tessera::io
