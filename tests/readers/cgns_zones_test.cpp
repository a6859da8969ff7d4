// SPDX-License-Identifier: BSD-3-Clause
// CGNS files written by the CGNS library: zones whose faces are numbered anywhere among their cells. Each is a row of
// cubes, whose cell data are their numbers in the zone's order.
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <vtk_cgns.h>

#include VTK_CGNS(cgnslib.h)
#include VTK_CGNS(cgns_io.h)

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "support/mesh_checks.hpp"
#include "support/parts_checks.hpp"
#include "support/read_files.hpp"
#include "support/temporary_folder.hpp"

namespace tessera::io::cgns_zones_test {
namespace {

using Numbers = std::vector<cgsize_t>;

/// Elements of one type numbered from `first` on; those of NGON_n, NFACE_n and MIXED with offsets.
struct Section {
  CGNS_ENUMT(ElementType_t) type;
  cgsize_t first;
  Numbers numbers, offsets{};
  Numbers parents{};
};

void require(int status) { ASSERT_EQ(status, CG_OK) << cg_get_error(); }

/// An open file with one base.
class CgnsWriter {
 public:
  explicit CgnsWriter(const std::filesystem::path& file,
                      const std::array<const char*, 3>& axes = {"CoordinateX", "CoordinateY", "CoordinateZ"})
      : axes_(axes) {
    require(cg_open(file.c_str(), CG_MODE_WRITE, &id_));
    require(cg_base_write(id_, "base", 3, 3, &base_));
  }
  void close() const { require(cg_close(id_)); }

  void begin_zone(const std::string& name, const std::vector<glm::dvec3>& points, std::size_t cells,
                  Numbers structured = {}) {
    points_ = points.size(), cells_ = cells;
    std::array<cgsize_t, 9> size{static_cast<cgsize_t>(points.size()), static_cast<cgsize_t>(cells)};
    std::ranges::copy(structured, size.begin());
    require(cg_zone_write(id_, base_, name.c_str(), size.data(),
                          structured.empty() ? CGNS_ENUMV(Unstructured) : CGNS_ENUMV(Structured), &zone_));
    write_coordinates(points, "");
  }

  void write_coordinates(const std::vector<glm::dvec3>& points, const std::string& grid) {
    const std::array<const char*, 3>& names = axes_;
    int made = 0;
    if (!grid.empty()) {
      require(cg_grid_write(id_, base_, zone_, grid.c_str(), &made));
      require(cg_goto(id_, base_, "Zone_t", zone_, "GridCoordinates_t", made, "end"));
    }
    for (int a = 0; a < 3; ++a) {
      std::vector<double> values;
      values.reserve(points.size());
      for (const glm::dvec3& p : points) values.push_back(p[a]);
      const auto count = static_cast<cgsize_t>(values.size());
      require(grid.empty() ? cg_coord_write(id_, base_, zone_, CGNS_ENUMV(RealDouble),
                                            names[static_cast<std::size_t>(a)], values.data(), &made)
                           : cg_array_write(names[static_cast<std::size_t>(a)], CGNS_ENUMV(RealDouble), 1, &count,
                                            values.data()));
    }
  }

  void write(const Section& section, cgsize_t count) {
    int made = 0;
    const std::string name = fmt::format("section {}", section.first);
    const cgsize_t last = section.first + count - 1;
    if (section.offsets.empty())
      require(cg_section_write(id_, base_, zone_, name.c_str(), section.type, section.first, last, 0,
                               section.numbers.data(), &made));
    else
      require(cg_poly_section_write(id_, base_, zone_, name.c_str(), section.type, section.first, last, 0,
                                    section.numbers.data(), section.offsets.data(), &made));
    if (!section.parents.empty()) require(cg_parent_data_write(id_, base_, zone_, made, section.parents.data()));
  }

  void write_values(const std::string& name, CGNS_ENUMT(GridLocation_t) location,
                    const std::vector<std::pair<std::string, std::vector<double>>>& fields) {
    int solution = 0, made = 0;
    require(cg_sol_write(id_, base_, zone_, name.c_str(), location, &solution));
    for (const auto& [field, values] : fields)
      require(cg_field_write(id_, base_, zone_, solution, CGNS_ENUMV(RealDouble), field.c_str(), values.data(), &made));
  }

  /// A field of only those points or cells that `indices` lists.
  void write_part(const std::string& name, CGNS_ENUMT(GridLocation_t) location, CGNS_ENUMT(PointSetType_t) set,
                  cgsize_t count, const Numbers& indices, const std::string& field, const std::vector<double>& values) {
    int solution = 0, made = 0;
    require(cg_sol_ptset_write(id_, base_, zone_, name.c_str(), location, set, count, indices.data(), &solution));
    require(cg_field_write(id_, base_, zone_, solution, CGNS_ENUMV(RealDouble), field.c_str(), values.data(), &made));
  }

  /// Angles of the base are in degrees.
  void write_degrees() const {
    require(cg_goto(id_, base_, "end"));
    require(cg_units_write(CGNS_ENUMV(Kilogram), CGNS_ENUMV(Meter), CGNS_ENUMV(Second), CGNS_ENUMV(Kelvin),
                           CGNS_ENUMV(Degree)));
  }

  /// Times, and for each the solutions and grids of the current zone.
  void write_steps(const std::vector<double>& times, const std::vector<std::string>& solutions,
                   const std::vector<std::string>& grids) {
    const auto steps = static_cast<cgsize_t>(times.size());
    require(cg_biter_write(id_, base_, "times", static_cast<int>(steps)));
    require(cg_goto(id_, base_, "BaseIterativeData_t", 1, "end"));
    require(cg_array_write("TimeValues", CGNS_ENUMV(RealDouble), 1, &steps, times.data()));
    require(cg_ziter_write(id_, base_, zone_, "steps"));
    require(cg_goto(id_, base_, "Zone_t", zone_, "ZoneIterativeData_t", 1, "end"));
    const std::array<cgsize_t, 2> size{32, steps};
    for (const auto& [array, names] :
         {std::pair("FlowSolutionPointers", solutions), std::pair("GridCoordinatesPointers", grids)}) {
      std::string all;
      for (const std::string& name : names) all += fmt::format("{:32}", name);
      if (!all.empty()) require(cg_array_write(array, CGNS_ENUMV(Character), 2, size.data(), all.data()));
    }
  }

 private:
  std::array<const char*, 3> axes_;
  int id_ = 0, base_ = 0, zone_ = 0;
  std::size_t points_ = 0, cells_ = 0;
};

/// Converts the file to CGNS before 3.4: without ElementStartOffset. Sections of NGON_n and NFACE_n have the length of
/// each element before its numbers instead.
void make_old(const std::filesystem::path& file, const std::vector<std::string>& lengths_among_numbers,
              const std::vector<std::string>& others = {}) {
  static_assert(sizeof(cgsize_t) == 8);
  int io = 0;
  double root = 0;
  require(cgio_open_file(file.c_str(), CGIO_MODE_MODIFY, CGIO_FILE_NONE, &io));
  require(cgio_get_root_id(io, &root));
  const auto node = [&](const std::string& path) {
    double id = 0;
    require(cgio_get_node_id(io, root, path.c_str(), &id));
    return id;
  };
  const auto numbers_of = [&](double id) {
    int dimensions = 0;
    std::array<cgsize_t, 12> size{};
    require(cgio_get_dimensions(io, id, &dimensions, size.data()));
    Numbers numbers(static_cast<std::size_t>(size[0]));
    require(cgio_read_all_data_type(io, id, "I8", numbers.data()));
    return numbers;
  };
  const float version = 3.21f;
  require(cgio_write_all_data(io, node("/CGNSLibraryVersion"), &version));
  std::vector<std::string> sections = lengths_among_numbers;
  sections.insert(sections.end(), others.begin(), others.end());
  for (const std::string& name : sections) {
    const std::string path = "/base/zone/" + name;
    const double offsets_node = node(path + "/ElementStartOffset"), numbers_node = node(path + "/ElementConnectivity");
    const Numbers offsets = numbers_of(offsets_node), numbers = numbers_of(numbers_node);
    require(cgio_delete_node(io, node(path), offsets_node));
    if (std::ranges::find(others, name) != others.end()) continue;
    Numbers old;
    for (std::size_t k = 0; k + 1 < offsets.size(); ++k) {
      old.push_back(offsets[k + 1] - offsets[k]);
      old.insert(old.end(), numbers.begin() + offsets[k], numbers.begin() + offsets[k + 1]);
    }
    const auto size = static_cast<cgsize_t>(old.size());
    require(cgio_set_dimensions(io, numbers_node, "I8", 1, &size));
    require(cgio_write_all_data(io, numbers_node, old.data()));
  }
  require(cgio_close_file(io));
}

/// `n` cubes along x, from x = `from` on.
struct Row {
  explicit Row(int cubes, double from = 0) : n(cubes) {
    for (int yz = 0; yz < 4; ++yz)
      for (int i = 0; i <= n; ++i) points.emplace_back(from + i, yz % 2, yz / 2);
  }
  [[nodiscard]] cgsize_t point(int i, int y, int z) const { return i + (n + 1) * (y + 2 * z) + 1; }
  [[nodiscard]] Numbers cube(int i) const {
    return {point(i, 0, 0), point(i + 1, 0, 0), point(i + 1, 1, 0), point(i, 1, 0),
            point(i, 0, 1), point(i + 1, 0, 1), point(i + 1, 1, 1), point(i, 1, 1)};
  }
  [[nodiscard]] Numbers side(int i) const { return {point(i, 0, 0), point(i, 1, 0), point(i, 1, 1), point(i, 0, 1)}; }

  int n;
  std::vector<glm::dvec3> points;
};

Section cubes(const Row& row, int from, int to, cgsize_t first) {
  Section section{CGNS_ENUMV(HEXA_8), first, {}};
  for (int i = from; i < to; ++i)
    for (const cgsize_t v : row.cube(i)) section.numbers.push_back(v);
  return section;
}
Section sides(const Row& row, cgsize_t first) {
  Section section{CGNS_ENUMV(QUAD_4), first, row.side(0)};
  for (const cgsize_t v : row.side(row.n)) section.numbers.push_back(v);
  return section;
}

std::vector<double> counted(std::size_t n, double from = 0) {
  std::vector<double> values;
  for (std::size_t k = 0; k < n; ++k) values.push_back(from + static_cast<double>(k));
  return values;
}

cells::MeshFile read(const std::filesystem::path& file, const std::string& field = "cell:f",
                     std::optional<std::size_t> step = {}) {
  ReadOptions options;
  options.field = field;
  options.time_step = step;
  return read_mesh(file, options);
}

/// The cube at x has the value `from` + x.
void expect_row(const cells::MeshFile& file, int n, double from = 0) {
  EXPECT_NEAR(testing::volume(file.mesh), n, 1e-12);
  EXPECT_EQ(file.counts.cells_read, static_cast<std::uint64_t>(n));
  for (std::size_t t = 0; t < file.mesh.tets.size(); ++t) {
    double x = 0;
    for (const std::uint32_t v : file.mesh.tets[t]) x += 0.25 * file.mesh.positions[v].x;
    EXPECT_EQ(file.mesh.scalars[t], from + std::floor(x));
  }
}

TEST(CgnsZones, CellsAreInTheOrderOfTheirNumbersWhereverFacesAre) {
  const test::TemporaryFolder folder;
  const Row row(5);
  struct Layout {
    cgsize_t left, right, faces;  ///< first element numbers: of cubes 0 and 1, of 2 to 4, of two faces
    std::array<int, 3> order;     ///< order of these three in the file
  };
  for (const Layout& layout :
       {Layout{1, 3, 6, {0, 1, 2}}, Layout{3, 5, 1, {0, 1, 2}}, Layout{3, 5, 1, {2, 0, 1}}, Layout{1, 5, 3, {0, 2, 1}},
        Layout{1, 3, 6, {1, 0, 2}}, Layout{3, 5, 1, {1, 2, 0}}, Layout{101, 203, 7, {1, 2, 0}}}) {
    SCOPED_TRACE(fmt::format("{} {} {}", layout.left, layout.right, layout.faces));
    CgnsWriter file(folder / "a.cgns");
    file.begin_zone("zone", row.points, 5);
    for (const int part : layout.order) {
      if (part == 0) file.write(cubes(row, 0, 2, layout.left), 2);
      if (part == 1) file.write(cubes(row, 2, 5, layout.right), 3);
      if (part == 2) file.write(sides(row, layout.faces), 2);
    }
    file.write_values("cells", CGNS_ENUMV(CellCenter), {{"f", counted(5)}});
    std::vector<double> xs;
    for (const glm::dvec3& p : row.points) xs.push_back(p.x);
    file.write_values("points", CGNS_ENUMV(Vertex), {{"g", xs}, {"VX", xs}, {"VY", xs}, {"VZ", xs}});
    file.close();
    expect_row(read(folder / "a.cgns"), 5);
    for (const char* field : {"point:g", "V:x"}) {
      const cells::MeshFile points = read(folder / "a.cgns", field);
      for (std::size_t v = 0; v < points.mesh.positions.size(); ++v)
        EXPECT_EQ(points.mesh.scalars[v], points.mesh.positions[v].x);
    }
  }
}

TEST(CgnsZones, AcceptsMoreFacesThanCellsNumberedFirst) {
  const test::TemporaryFolder folder;
  const Row row(1);
  CgnsWriter file(folder / "a.cgns");
  file.begin_zone("zone", row.points, 1);
  file.write(sides(row, 1), 2);
  file.write(cubes(row, 0, 1, 3), 1);
  file.write_values("cells", CGNS_ENUMV(CellCenter), {{"f", counted(1)}});
  file.close();
  expect_row(read(folder / "a.cgns"), 1);
}

TEST(CgnsZones, MixedSectionsHoldFacesAmongTheCells) {
  const test::TemporaryFolder folder;
  const Row row(3);
  Section mixed{CGNS_ENUMV(MIXED), 1, {}, {0}};
  const auto add = [&](CGNS_ENUMT(ElementType_t) type, const Numbers& nodes) {
    mixed.numbers.push_back(type);
    mixed.numbers.insert(mixed.numbers.end(), nodes.begin(), nodes.end());
    mixed.offsets.push_back(static_cast<cgsize_t>(mixed.numbers.size()));
  };
  add(CGNS_ENUMV(QUAD_4), row.side(0));
  add(CGNS_ENUMV(HEXA_8), row.cube(0));
  add(CGNS_ENUMV(QUAD_4), row.side(1));
  const Numbers c = row.cube(1);
  add(CGNS_ENUMV(PENTA_6), {c[0], c[1], c[2], c[4], c[5], c[6]});
  add(CGNS_ENUMV(PENTA_6), {c[0], c[2], c[3], c[4], c[6], c[7]});
  add(CGNS_ENUMV(BAR_2), {1, 2});
  add(CGNS_ENUMV(HEXA_8), row.cube(2));
  CgnsWriter file(folder / "a.cgns");
  file.begin_zone("zone", row.points, 4);
  file.write(mixed, 7);
  file.write_values("cells", CGNS_ENUMV(CellCenter), {{"f", {0, 1, 1, 2}}});
  file.close();
  for (const bool is_old : {false, true}) {
    SCOPED_TRACE(is_old);
    if (is_old) make_old(folder / "a.cgns", {}, {"section 1"});
    const cells::MeshFile mesh = read(folder / "a.cgns");
    EXPECT_EQ(mesh.counts.cells_read, 4u);
    EXPECT_NEAR(testing::volume(mesh.mesh), 3, 1e-12);
    for (std::size_t t = 0; t < mesh.mesh.tets.size(); ++t) {
      double x = 0;
      for (const std::uint32_t v : mesh.mesh.tets[t]) x += 0.25 * mesh.mesh.positions[v].x;
      EXPECT_EQ(mesh.mesh.scalars[t], std::floor(x));
    }
  }
}

/// The faces of a row of cubes: those between and at the ends, then four around each.
struct Faces {
  explicit Faces(const Row& row) {
    for (int i = 0; i <= row.n; ++i) add(row.side(i), i, i + 1, row.n);
    for (int i = 0; i < row.n; ++i) {
      const Numbers c = row.cube(i);
      for (const auto& corners : {Numbers{c[0], c[1], c[2], c[3]}, Numbers{c[4], c[5], c[6], c[7]},
                                  Numbers{c[0], c[1], c[5], c[4]}, Numbers{c[3], c[2], c[6], c[7]}})
        add(corners, i + 1, 0, row.n);
    }
  }
  void add(const Numbers& corners, int left, int right, int n) {
    nodes.insert(nodes.end(), corners.begin(), corners.end());
    offsets.push_back(static_cast<cgsize_t>(nodes.size()));
    sides.push_back({left >= 1 && left <= n ? left : 0, right >= 1 && right <= n ? right : 0});
  }

  Numbers nodes, offsets{0};
  std::vector<std::array<int, 2>> sides;  ///< the cubes on both sides, numbered from 1; 0: no cube
};

TEST(CgnsZones, PolyhedraAreNumberedBeforeOrAfterTheirFaces) {
  const test::TemporaryFolder folder;
  const Row row(3);
  const Faces faces(row);
  const auto face_count = static_cast<cgsize_t>(faces.sides.size());
  for (const bool cells_first : {false, true})
    for (const bool with_bars : {false, true}) {
      SCOPED_TRACE(fmt::format("{} {}", cells_first, with_bars));
      const cgsize_t first_face = cells_first ? 4 : 1, first_cell = cells_first ? 1 : face_count + 1;
      Section cells{CGNS_ENUMV(NFACE_n), first_cell, {}, {0}};
      for (int i = 1; i <= 3; ++i) {
        for (std::size_t f = 0; f < faces.sides.size(); ++f) {
          const auto number = first_face + static_cast<cgsize_t>(f);
          if (faces.sides[f][0] == i) cells.numbers.push_back(number);
          if (faces.sides[f][1] == i) cells.numbers.push_back(-number);
        }
        cells.offsets.push_back(static_cast<cgsize_t>(cells.numbers.size()));
      }
      CgnsWriter file(folder / "a.cgns");
      file.begin_zone("zone", row.points, 3);
      if (with_bars) file.write({CGNS_ENUMV(BAR_2), 500, {1, 2}}, 1);
      if (cells_first) file.write(cells, 3);
      file.write({CGNS_ENUMV(NGON_n), first_face, faces.nodes, faces.offsets}, face_count);
      if (!cells_first) file.write(cells, 3);
      file.write_values("cells", CGNS_ENUMV(CellCenter), {{"f", counted(3)}});
      file.close();
      for (const bool is_old : {false, true}) {
        SCOPED_TRACE(is_old);
        if (is_old)
          make_old(folder / "a.cgns", {fmt::format("section {}", first_face), fmt::format("section {}", first_cell)});
        const cells::MeshFile mesh = read(folder / "a.cgns");
        EXPECT_EQ(mesh.counts.cells_polyhedra, 3u);
        expect_row(mesh, 3);
      }
    }
}

TEST(CgnsZones, PolyhedraAreThoseThatTheirFacesHaveAsParents) {
  const test::TemporaryFolder folder;
  const Row row(3);
  const Faces faces(row);
  const auto count = static_cast<cgsize_t>(faces.sides.size());
  Numbers parents(4 * faces.sides.size());
  for (std::size_t f = 0; f < faces.sides.size(); ++f)
    for (std::size_t side = 0; side < 2; ++side)
      if (faces.sides[f][side] > 0) parents[side * faces.sides.size() + f] = count + faces.sides[f][side];
  CgnsWriter file(folder / "a.cgns");
  file.begin_zone("zone", row.points, 3);
  file.write({CGNS_ENUMV(NGON_n), 1, faces.nodes, faces.offsets, parents}, count);
  file.write_values("cells", CGNS_ENUMV(CellCenter), {{"f", counted(3)}});
  file.close();
  for (const bool is_old : {false, true}) {
    SCOPED_TRACE(is_old);
    if (is_old) make_old(folder / "a.cgns", {"section 1"});
    const cells::MeshFile mesh = read(folder / "a.cgns");
    EXPECT_EQ(mesh.counts.cells_polyhedra, 3u);
    expect_row(mesh, 3);
  }
}

TEST(CgnsZones, HDF5BehindAUserBlockIsNamed) {
  const test::TemporaryFolder folder;
  const Row row(3);
  CgnsWriter file(folder / "a.cgns");
  file.begin_zone("zone", row.points, 3);
  file.write(cubes(row, 0, 3, 1), 3);
  file.close();
  folder.write("b.cgns", std::string(1024, 'u') + test::contents(folder / "a.cgns"));
  const std::string message = testing::message_of([&] { read(folder / "b.cgns", ""); });
  EXPECT_NE(message.find("CGNS after a user block"), std::string::npos) << message;
  EXPECT_NE(message.find("h5unjam -i FILE -u BLOCK -o OUT.cgns"), std::string::npos) << message;
}

TEST(CgnsZones, ZonesOfEveryKindAreBlocksAndShares) {
  const test::TemporaryFolder folder;
  CgnsWriter file(folder / "a.cgns");
  const Row first(2), second(3, 2), third(2, 5);
  file.begin_zone("faces first", first.points, 2);
  file.write(sides(first, 1), 2);
  file.write(cubes(first, 0, 2, 3), 2);
  file.write_values("cells", CGNS_ENUMV(CellCenter), {{"f", counted(2)}});
  file.begin_zone("cells first", second.points, 3);
  file.write(cubes(second, 0, 3, 1), 3);
  file.write(sides(second, 4), 2);
  file.write_values("cells", CGNS_ENUMV(CellCenter), {{"f", counted(3, 2)}});
  file.begin_zone("structured", third.points, 2, {3, 2, 2, 2, 1, 1, 0, 0, 0});
  file.write_values("cells", CGNS_ENUMV(CellCenter), {{"f", counted(2, 5)}});
  file.close();
  const cells::MeshFile whole = read(folder / "a.cgns");
  expect_row(whole, 7);
  EXPECT_EQ(whole.blocks, (std::vector<std::string>{"base/cells first", "base/faces first", "base/structured"}));
  ReadOptions options;
  options.field = "cell:f";
  testing::expect_as_whole(folder / "a.cgns", options);
  options.blocks = {"structured"};
  EXPECT_EQ(read_mesh(folder / "a.cgns", options).counts.cells_read, 2u);
}

TEST(CgnsZones, StepsHaveTheirOwnSolutionsAndGrids) {
  const test::TemporaryFolder folder;
  const Row row(2), moved(2, 10);
  CgnsWriter file(folder / "a.cgns");
  file.begin_zone("zone", row.points, 2);
  file.write_coordinates(moved.points, "moved");
  file.write(sides(row, 1), 2);
  file.write(cubes(row, 0, 2, 3), 2);
  file.write_values("early", CGNS_ENUMV(CellCenter), {{"f", counted(2)}});
  file.write_values("late", CGNS_ENUMV(CellCenter), {{"f", counted(2, 10)}});
  file.write_steps({0.5, 2}, {"early", "late"}, {"GridCoordinates", "moved"});
  file.close();
  for (const std::size_t step : {0u, 1u}) {
    const cells::MeshFile mesh = read(folder / "a.cgns", "cell:f", step);
    EXPECT_EQ(mesh.time_step.count, 2u);
    EXPECT_EQ(mesh.time_step.times, (std::vector<double>{0.5, 2}));
    expect_row(mesh, 2);
    EXPECT_EQ(*std::ranges::max_element(mesh.mesh.scalars), step == 0 ? 1 : 11);
  }
  test::expect_bad_input([&] { read(folder / "a.cgns", "cell:f", 2); }, {"no time step 2"});
}

TEST(CgnsZones, CellsOfSecondOrderHaveTheirNodesInVtksOrder) {
  // Nodes in the middles of edges and faces are given by the corners, numbered from 1 (CGNS SIDS, figures of the
  // elements).
  using Groups = std::vector<Numbers>;
  struct Case {
    CGNS_ENUMT(ElementType_t) type;
    std::size_t corners;
    Groups middles;
  };
  const Groups edges = {{1, 2}, {2, 3}, {3, 4}, {4, 1}, {1, 5}, {2, 6}, {3, 7}, {4, 8}, {5, 6}, {6, 7}, {7, 8}, {8, 5}};
  Groups with_faces = edges;
  for (const Numbers& face : {Numbers{1, 4, 3, 2}, Numbers{1, 2, 6, 5}, Numbers{2, 3, 7, 6}, Numbers{3, 4, 8, 7},
                              Numbers{1, 5, 8, 4}, Numbers{5, 6, 7, 8}, Numbers{1, 2, 3, 4, 5, 6, 7, 8}})
    with_faces.push_back(face);
  const Groups prism = {{1, 2}, {2, 3}, {3, 1}, {1, 4}, {2, 5}, {3, 6}, {4, 5}, {5, 6}, {6, 4}};
  Groups prism_faces = prism;
  for (const Numbers& face : {Numbers{1, 2, 5, 4}, Numbers{2, 3, 6, 5}, Numbers{3, 1, 4, 6}})
    prism_faces.push_back(face);
  const Groups pyramid = {{1, 2}, {2, 3}, {3, 4}, {4, 1}, {1, 5}, {2, 5}, {3, 5}, {4, 5}};
  Groups pyramid_base = pyramid;
  pyramid_base.push_back({1, 2, 3, 4});
  const std::vector<Case> cases = {{CGNS_ENUMV(TETRA_10), 4, {{1, 2}, {2, 3}, {3, 1}, {1, 4}, {2, 4}, {3, 4}}},
                                   {CGNS_ENUMV(PYRA_13), 5, pyramid},
                                   {CGNS_ENUMV(PYRA_14), 5, pyramid_base},
                                   {CGNS_ENUMV(PENTA_15), 6, prism},
                                   {CGNS_ENUMV(PENTA_18), 6, prism_faces},
                                   {CGNS_ENUMV(HEXA_20), 8, edges},
                                   {CGNS_ENUMV(HEXA_27), 8, with_faces}};
  const std::vector<glm::dvec3> hexahedron = {{0, 0, 0}, {2, 0, 0}, {2, 3, 0}, {0, 3, 0},
                                              {0, 0, 5}, {2, 0, 5}, {2, 3, 5}, {0, 3, 5}};
  const std::vector<glm::dvec3> wedge = {{0, 0, 0}, {2, 0, 0}, {0, 3, 0}, {0, 0, 5}, {2, 0, 5}, {0, 3, 5}};
  const std::vector<glm::dvec3> point = {{0, 0, 0}, {2, 0, 0}, {2, 3, 0}, {0, 3, 0}, {1, 1, 5}};
  const std::vector<glm::dvec3> tetrahedron = {{0, 0, 0}, {2, 0, 0}, {0, 3, 0}, {0, 0, 5}};
  const test::TemporaryFolder folder;
  for (const Case& c : cases) {
    SCOPED_TRACE(cg_ElementTypeName(c.type));
    std::vector<glm::dvec3> points = c.corners == 8   ? hexahedron
                                     : c.corners == 6 ? wedge
                                     : c.corners == 5 ? point
                                                      : tetrahedron;
    for (const Numbers& of : c.middles) {
      glm::dvec3 sum(0);
      for (const cgsize_t v : of) sum += points[static_cast<std::size_t>(v) - 1];
      points.push_back(sum / static_cast<double>(of.size()));
    }
    Section cell{c.type, 2, {}};
    for (std::size_t v = 1; v <= points.size(); ++v) cell.numbers.push_back(static_cast<cgsize_t>(v));
    CgnsWriter file(folder / "a.cgns");
    file.begin_zone("zone", points, 1);
    file.write({CGNS_ENUMV(TRI_3), 1, {1, 2, 3}}, 1);
    file.write(cell, 1);
    std::vector<double> values;
    values.reserve(points.size());
    for (const glm::dvec3& p : points) values.push_back(p.x + 2 * p.y + 3 * p.z);
    file.write_values("points", CGNS_ENUMV(Vertex), {{"f", values}});
    file.close();
    const cells::MeshFile mesh = read(folder / "a.cgns", "f");
    // All nodes are where a straight cell has them: a misplaced node moves the surface and the field.
    EXPECT_NEAR(testing::volume(mesh.mesh), c.corners == 8 ? 30 : c.corners == 6 ? 15 : c.corners == 5 ? 10 : 5, 1e-9);
    for (std::size_t v = 0; v < mesh.mesh.positions.size(); ++v) {
      const glm::dvec3& p = mesh.mesh.positions[v];
      EXPECT_NEAR(mesh.mesh.scalars[v], p.x + 2 * p.y + 3 * p.z, 1e-9);
    }
  }
}

TEST(CgnsZones, SolutionsOfSomePointsOrCellsAreBlankElsewhere) {
  const test::TemporaryFolder folder;
  const Row row(4);
  const auto& n = row.points;
  struct Case {
    bool is_structured;
    CGNS_ENUMT(GridLocation_t) location;
    CGNS_ENUMT(PointSetType_t) set;
    cgsize_t count;
    Numbers indices;
    std::vector<std::size_t> places;
  };
  const auto point = CGNS_ENUMV(Vertex), cell = CGNS_ENUMV(CellCenter);
  const auto range = CGNS_ENUMV(PointRange), list = CGNS_ENUMV(PointList);
  for (const Case& c : {Case{false, cell, range, 2, {2, 3}, {1, 2}}, Case{false, cell, list, 3, {4, 1, 2}, {3, 0, 1}},
                        Case{false, point, list, 8, {17, 2, 1, 6, 7, 12, 11, 16}, {16, 1, 0, 5, 6, 11, 10, 15}},
                        Case{true, cell, range, 2, {2, 1, 1, 4, 1, 1}, {1, 2, 3}},
                        Case{true, cell, list, 2, {4, 1, 1, 1, 1, 1}, {3, 0}},
                        Case{true, point, range, 2, {2, 1, 1, 3, 2, 2}, {1, 2, 6, 7, 11, 12, 16, 17}}}) {
    SCOPED_TRACE(fmt::format("{} {} {}", c.is_structured, static_cast<int>(c.location), static_cast<int>(c.set)));
    std::vector<double> values;
    for (const std::size_t place : c.places) values.push_back(100 + static_cast<double>(place));
    CgnsWriter file(folder / "a.cgns");
    file.begin_zone("zone", n, 4, c.is_structured ? Numbers{5, 2, 2, 4, 1, 1, 0, 0, 0} : Numbers{});
    if (!c.is_structured) file.write(cubes(row, 0, 4, 1), 4);
    file.write_part("some", c.location, c.set, c.count, c.indices, "f", values);
    file.close();
    ReadOptions options;
    options.field = c.location == cell ? "cell:f" : "point:f";
    const cells::MeshFile mesh = read_mesh(folder / "a.cgns", options);
    std::uint64_t kept = 0;
    for (std::size_t i = 0; i < 4; ++i) kept += c.location == cell ? std::ranges::count(c.places, i) : 0;
    if (c.location == point) kept = 1;  // only one cube has values at all corners
    EXPECT_EQ(mesh.counts.cells_nan, 4 - kept);
    EXPECT_NEAR(testing::volume(mesh.mesh), static_cast<double>(kept), 1e-12);
    for (std::size_t t = 0; t < mesh.mesh.tets.size() && c.location == cell; ++t) {
      double x = 0;
      for (const std::uint32_t v : mesh.mesh.tets[t]) x += 0.25 * mesh.mesh.positions[v].x;
      EXPECT_EQ(mesh.mesh.scalars[t], 100 + std::floor(x));
    }
    if (c.location != point) continue;
    for (const auto& tet : mesh.mesh.tets)
      for (const std::uint32_t v : tet) {
        const glm::dvec3 p = mesh.mesh.positions[v];
        EXPECT_EQ(mesh.mesh.scalars[v], 100 + p.x + 5 * p.y + 10 * p.z);
      }
  }
  CgnsWriter file(folder / "b.cgns");
  file.begin_zone("zone", n, 4);
  file.write(cubes(row, 0, 4, 1), 4);
  file.write_part("left", cell, list, 2, {1, 2}, "f", {0, 1});
  file.write_part("right", cell, list, 2, {4, 3}, "f", {3, 2});
  file.close();
  expect_row(read(folder / "b.cgns"), 4);
  CgnsWriter far(folder / "c.cgns");
  far.begin_zone("zone", n, 4);
  far.write(cubes(row, 0, 4, 1), 4);
  far.write_part("some", cell, list, 1, {5}, "f", {0});
  far.close();
  test::expect_bad_input([&] { read(folder / "c.cgns"); },
                         {"c.cgns: base/zone", "'some'", "index 5, which is not from 1 to 4"});
}

TEST(CgnsZones, ReadsFieldsOfOneNameFromSeveralSolutions) {
  const test::TemporaryFolder folder;
  const Row row(3);
  CgnsWriter file(folder / "a.cgns");
  file.begin_zone("zone", row.points, 3);
  file.write(cubes(row, 0, 3, 1), 3);
  const std::vector<double> zeros(3);
  file.write_values("Inst", CGNS_ENUMV(CellCenter),
                    {{"f", counted(3)}, {"VX", counted(3)}, {"VY", zeros}, {"VZ", zeros}});
  file.write_values(
      "Mean", CGNS_ENUMV(CellCenter),
      {{"f", counted(3, 10)}, {"VX", counted(3, 20)}, {"VY", zeros}, {"VZ", zeros}, {"g", counted(3, 30)}});
  file.write_values("Points", CGNS_ENUMV(Vertex), {{"f", std::vector<double>(16, 0.5)}});
  file.close();
  for (const auto& [field, from] : {std::pair("Inst/f", 0.), std::pair("Mean/f", 10.), std::pair("Inst/V:x", 0.),
                                    std::pair("Mean/V:x", 20.), std::pair("g", 30.)})
    expect_row(read(folder / "a.cgns", field), 3, from);
  EXPECT_EQ(read(folder / "a.cgns", "point:f").mesh.scalars.front(), 0.5);
}

TEST(CgnsZones, CylinderCoordinatesAreTurnedToXyz) {
  const test::TemporaryFolder folder;
  for (const bool is_structured : {false, true})
    for (const bool in_degrees : {false, true}) {
      // A quarter of a ring of radii 1 and 3 in 90 steps, two high.
      Row row(90);
      const double quarter = in_degrees ? 90 : std::numbers::pi / 2;
      for (glm::dvec3& p : row.points) p = {3 - 2 * p.y, quarter * p.x / 90, 2 * p.z};
      CgnsWriter file(folder / "a.cgns", {"CoordinateR", "CoordinateTheta", "CoordinateZ"});
      file.begin_zone("zone", row.points, 90, is_structured ? Numbers{91, 2, 2, 90, 1, 1, 0, 0, 0} : Numbers{});
      if (!is_structured) file.write(cubes(row, 0, 90, 1), 90);
      if (in_degrees) file.write_degrees();
      file.write_values("cells", CGNS_ENUMV(CellCenter), {{"f", counted(90)}});
      file.close();
      const cells::MeshFile mesh = read(folder / "a.cgns");
      EXPECT_NEAR(testing::volume(mesh.mesh), 2 * 4 * 90 * std::sin(std::numbers::pi / 180), 1e-5);
      for (const auto& p : mesh.mesh.positions) {
        EXPECT_GE(p.x, -1e-6);
        EXPECT_GE(p.y, -1e-6);
        EXPECT_LT(std::min(std::abs(std::hypot(p.x, p.y) - 1), std::abs(std::hypot(p.x, p.y) - 3)), 1e-5);
      }
    }
  CgnsWriter sphere(folder / "b.cgns", {"CoordinateR", "CoordinateTheta", "CoordinatePhi"});
  const Row row(1);
  sphere.begin_zone("zone", row.points, 1);
  sphere.write(cubes(row, 0, 1, 1), 1);
  sphere.close();
  test::expect_bad_input([&] { read_mesh(folder / "b.cgns"); }, {"base/zone", "2 of CoordinateR", "not supported"});
}

TEST(CgnsZones, NamesWhatIsNotRead) {
  const test::TemporaryFolder folder;
  const Row row(2);
  CgnsWriter file(folder / "a.cgns");
  file.begin_zone("zone", row.points, 2);
  file.write(sides(row, 1), 2);
  file.close();
  test::expect_bad_input([&] { read(folder / "a.cgns"); }, {"a.cgns", "no cells of three dimensions"});
  CgnsWriter twice(folder / "b.cgns");
  twice.begin_zone("zone", row.points, 2);
  twice.write(sides(row, 1), 2);
  twice.write(cubes(row, 0, 2, 2), 2);
  twice.close();
  test::expect_bad_input([&] { read(folder / "b.cgns"); }, {"b.cgns: base/zone", "repeats the number 2"});
}

}  // namespace
}  // namespace tessera::io::cgns_zones_test
