#include "io/helper/cgns_cells.hpp"
// The library's macros come first.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "io/helper/cgns_zones.hpp"
#include "io/helper/readers.hpp"
#include "io/helper/serve.hpp"
#include "io/part_range.hpp"
#include "scene/error.hpp"

namespace tessera::io::helper {
namespace {

using Name = std::array<char, 34>;

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
    Name base_name{};
    int dimensions = 0, physical = 0, count = 0;
    require_cgns(cg_base_read(file.id(), base, base_name.data(), &dimensions, &physical), about);
    require_cgns(cg_nzones(file.id(), base, &count), about);
    for (int k = 1; k <= count; ++k) {
      CgnsZone zone{.file = file.id(), .base = base, .zone = k, .where = source, .dimensions = dimensions};
      Name name{};
      require_cgns(cg_zone_read(file.id(), base, k, name.data(), zone.size.data()), zone);
      require_cgns(cg_zone_type(file.id(), base, k, &zone.type), zone);
      zone.name = fmt::format("{}/{}", base_name.data(), name.data());
      zone.where = fmt::format("{}: {}", source, zone.name);
      zones.push_back(std::move(zone));
    }
  }
  return zones;
}

bool is_mesh(const CgnsZone& zone) {
  return zone.dimensions == 3 && (zone.is_structured() || zone.type == CGNS_ENUMV(Unstructured));
}

/// Numbers along each index of a zone, of its points or cells.
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

/// The names that a node below a zone or base lists for a step, one of 32 letters each: of arrays whose name ends in
/// "Pointers" and has `word` in it.
std::vector<std::string> names_at_step(std::uint64_t step, std::string_view word) {
  std::vector<std::string> names;
  int arrays = 0;
  if (cg_narrays(&arrays) != CG_OK) return names;
  for (int a = 1; a <= arrays; ++a) {
    Name name{};
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

/// The names of a zone's grids or solutions at a step; none: the zone does not list them.
std::vector<std::string> zone_names_at_step(const CgnsZone& zone, std::uint64_t step, std::string_view word) {
  Name name{};
  if (cg_ziter_read(zone.file, zone.base, zone.zone, name.data()) != CG_OK ||
      cg_goto(zone.file, zone.base, "Zone_t", zone.zone, "ZoneIterativeData_t", 1, "end") != CG_OK)
    return {};
  return names_at_step(step, word);
}

/// Which grid of coordinates a zone has at a step.
int grid_at_step(const CgnsZone& zone, std::uint64_t step) {
  const std::vector<std::string> names = zone_names_at_step(zone, step, "GridCoordinates");
  int count = 0;
  require_cgns(cg_ngrids(zone.file, zone.base, zone.zone, &count), zone);
  for (int grid = 1; grid <= count; ++grid) {
    Name name{};
    require_cgns(cg_grid_read(zone.file, zone.base, zone.zone, grid, name.data()), zone);
    if (names.empty() ? std::string_view(name.data()) == "GridCoordinates" : names[0] == name.data()) return grid;
  }
  throw scene::bad_input(fmt::format("{}: it has no coordinates{}; export the file again", zone.where,
                                     names.empty() ? "" : fmt::format(" named '{}' for time step {}", names[0], step)));
}

void set_positions(const CgnsZone& zone, std::uint64_t step, CellBlock& block) {
  const int grid = grid_at_step(zone, step);
  const std::size_t points = product(zone, false);
  require_cgns(cg_goto(zone.file, zone.base, "Zone_t", zone.zone, "GridCoordinates_t", grid, "end"), zone);
  std::array<int, 6> rind{};
  const bool has_rind = cg_rind_read(rind.data()) == CG_OK && std::ranges::any_of(rind, [](int n) { return n != 0; });
  int arrays = 0;
  require_cgns(cg_narrays(&arrays), zone);
  block.positions.assign(points, glm::dvec3(0));
  std::vector<double> values(points);
  int found = 0;
  for (int a = 1; a <= arrays; ++a) {
    Name name{};
    CGNS_ENUMT(DataType_t) type{};
    int dimensions = 0;
    std::array<cgsize_t, 12> size{};
    require_cgns(cg_array_info(a, name.data(), &type, &dimensions, size.data()), zone);
    constexpr std::array<std::string_view, 3> axes = {"CoordinateX", "CoordinateY", "CoordinateZ"};
    const auto axis = std::ranges::find(axes, name.data()) - axes.begin();
    if (axis == 3) continue;
    std::size_t count = 1;
    for (int d = 0; d < dimensions; ++d) count *= static_cast<std::size_t>(size[static_cast<std::size_t>(d)]);
    if (has_rind || count != points)
      throw scene::bad_input(fmt::format("{}: its coordinates are {} numbers for {} points{}; export it without rind",
                                         zone.where, count, points, has_rind ? ", with rind" : ""));
    require_cgns(cg_array_read_as(a, CGNS_ENUMV(RealDouble), values.data()), zone);
    for (std::size_t v = 0; v < points; ++v) block.positions[v][static_cast<int>(axis)] = values[v];
    ++found;
  }
  if (found != 3)
    throw scene::bad_input(
        fmt::format("{}: it has {} of CoordinateX, CoordinateY and CoordinateZ; other coordinates "
                    "are not read, export these",
                    zone.where, found));
}

/// A zone's arrays of values by name, in the file's order, each with one number a point or cell.
struct Values {
  scene::Association association{};
  std::vector<std::pair<std::string, std::vector<double>>> arrays;

  [[nodiscard]] std::vector<double>* find(const std::string& name) {
    const auto found = std::ranges::find(arrays, name, &std::pair<std::string, std::vector<double>>::first);
    return found == arrays.end() ? nullptr : &found->second;
  }
};

/// NameX, NameY and NameZ become the vector Name, as VTK's reader has it.
void add_fields(Values values, CellBlock& block) {
  for (auto& [name, numbers] : values.arrays) {
    if (numbers.empty()) continue;  // used by a vector
    const std::string stem = name.substr(0, name.size() - 1);
    const std::string_view last = std::string_view(name).substr(stem.size());
    std::vector<double>*const x = values.find(stem + "X"), *const y = values.find(stem + "Y"),
                              *const z = values.find(stem + "Z");
    if (stem.empty() || (last != "X" && last != "Y" && last != "Z") || x == nullptr || y == nullptr || z == nullptr) {
      block.fields.push_back(field_of_values(name, "double", values.association, 1, std::move(numbers)));
      numbers.clear();
      continue;
    }
    std::vector<double> vectors;
    vectors.reserve(3 * x->size());
    for (std::size_t k = 0; k < x->size(); ++k) vectors.insert(vectors.end(), {(*x)[k], (*y)[k], (*z)[k]});
    x->clear(), y->clear(), z->clear();
    block.fields.push_back(field_of_values(stem, "double", values.association, 3, std::move(vectors)));
  }
}

void read_solution(const CgnsZone& zone, int solution, Values& values) {
  const bool of_cells = values.association == scene::Association::cell;
  const std::vector<cgsize_t> first(zone.is_structured() ? 3 : 1, 1), last = lengths(zone, of_cells);
  const std::size_t count = product(zone, of_cells);
  int fields = 0;
  require_cgns(cg_nfields(zone.file, zone.base, zone.zone, solution, &fields), zone);
  for (int k = 1; k <= fields && count > 0; ++k) {
    Name name{};
    CGNS_ENUMT(DataType_t) type{};
    require_cgns(cg_field_info(zone.file, zone.base, zone.zone, solution, k, &type, name.data()), zone);
    if (values.find(name.data()) != nullptr) continue;
    std::vector<double> numbers(count);
    require_cgns(cg_field_read(zone.file, zone.base, zone.zone, solution, name.data(), CGNS_ENUMV(RealDouble),
                               first.data(), last.data(), numbers.data()),
                 zone);
    values.arrays.emplace_back(name.data(), std::move(numbers));
  }
}

void set_fields(const CgnsZone& zone, std::uint64_t step, bool has_cell_values, CellBlock& block,
                std::vector<std::string>& notes) {
  const std::vector<std::string> names = zone_names_at_step(zone, step, "Solution");
  int count = 0;
  require_cgns(cg_nsols(zone.file, zone.base, zone.zone, &count), zone);
  Values points{scene::Association::point, {}}, cells{scene::Association::cell, {}};
  for (int solution = 1; solution <= count; ++solution) {
    Name name{};
    CGNS_ENUMT(GridLocation_t) location{};
    require_cgns(cg_sol_info(zone.file, zone.base, zone.zone, solution, name.data(), &location), zone);
    if (!names.empty() && std::ranges::count(names, name.data()) == 0) continue;
    CGNS_ENUMT(PointSetType_t) set{};
    cgsize_t in_set = 0;
    const bool is_part = cg_sol_ptset_info(zone.file, zone.base, zone.zone, solution, &set, &in_set) == CG_OK &&
                         set != CGNS_ENUMV(PointSetTypeNull);
    if (!is_part && location == CGNS_ENUMV(Vertex))
      read_solution(zone, solution, points);
    else if (!is_part && location == CGNS_ENUMV(CellCenter) && has_cell_values)
      read_solution(zone, solution, cells);
    else
      notes.push_back(fmt::format("'{}' of {} is left out: it has values {}", name.data(), zone.name,
                                  is_part                              ? "of some points or cells alone"
                                  : location == CGNS_ENUMV(CellCenter) ? "for another number of cells"
                                                                       : "of faces or edges"));
  }
  add_fields(std::move(points), block);
  add_fields(std::move(cells), block);
}

/// Nothing of a zone without cells of three dimensions.
std::optional<ForeignPart> part_of(Holdings& holdings, const CgnsZone& zone, std::uint64_t step,
                                   std::vector<std::string>& notes) {
  CellBlock block;
  block.name = zone.name;
  bool has_cell_values = true;
  if (!zone.is_structured()) {
    set_cells(zone, block);
    if (block.types.empty()) return std::nullopt;
    has_cell_values = block.types.size() == product(zone, true);
  }
  set_positions(zone, step, block);
  set_fields(zone, step, has_cell_values, block, notes);
  ForeignPart part = hold_block(holdings, std::move(block));
  if (!zone.is_structured()) return part;
  part.kind = ForeignPart::Kind::structured;
  for (std::size_t a = 0; a < 3; ++a) part.extent[2 * a + 1] = zone.size[a] - 1;
  for (auto* const array : {&part.types, &part.offsets, &part.connectivity}) {
    holdings.drop((*array)->number);
    array->reset();
  }
  return part;
}

/// Of the first base that has iterative data.
struct CgnsSteps {
  std::uint64_t count = 0;
  std::vector<double> times;
};

CgnsSteps steps_of(std::span<const CgnsZone> zones) {
  for (const CgnsZone& zone : zones) {
    Name name{};
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

std::optional<ForeignContents> read_cgns_zones(Holdings& holdings, const std::filesystem::path& file,
                                               const nlohmann::json& request) {
  const std::string source = file.string();
  const CgnsFile opened(file);
  if (!opened.is_open()) return std::nullopt;
  const std::vector<CgnsZone> zones = zones_of(opened, source);
  const auto needs_this = [](const CgnsZone& zone) {
    return is_mesh(zone) && !zone.is_structured() && !is_plain(zone);
  };
  if (std::ranges::none_of(zones, needs_this)) return std::nullopt;
  ForeignContents contents;
  contents.format = "CGNS";
  std::optional<std::size_t> wish;
  if (const auto step = request.find("time_step"); step != request.end()) wish = step->get<std::size_t>();
  CgnsSteps steps = steps_of(zones);
  contents.time_step = chosen_step(wish, steps.count, source);
  set_times(contents.time_step, std::move(steps.times));
  const int part = request.value("part", 0), parts = request.value("parts", 1);
  const std::uint64_t first = first_of_part(zones.size(), part, parts);
  const std::uint64_t last = first_of_part(zones.size(), part + 1, parts);
  for (std::uint64_t k = first; k < last; ++k) {
    if (!is_mesh(zones[k])) continue;
    report_progress(static_cast<double>(k - first) / static_cast<double>(last - first));
    if (auto read = part_of(holdings, zones[k], contents.time_step.step, contents.notes))
      contents.parts.push_back(std::move(*read));
  }
  if (contents.parts.empty() && parts == 1)
    throw scene::bad_input(
        fmt::format("{}: its zones have no cells of three dimensions; give a file with a volume mesh", source));
  return contents;
}

}  // namespace tessera::io::helper
