// SPDX-License-Identifier: BSD-3-Clause
// MED meshes and fields, written by MED's library.
#include <gtest/gtest.h>
#include <hdf5.h>
#include <med.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "io/files/reader_programs.hpp"
#include "io/mesh/mesh_formats.hpp"
#include "support/changed_bytes.hpp"
#include "support/curved_reference.hpp"
#include "support/mesh_checks.hpp"
#include "support/read_files.hpp"
#include "support/temporary_folder.hpp"

namespace tessera::io {
namespace {

constexpr const char* mesh_name = "bar";

void write_field(med_idt file, const char* name, med_int components, med_entity_type entity, med_geometry_type kind,
                 med_int step, med_int count, const std::vector<double>& values, const char* profile = MED_NO_PROFILE) {
  ASSERT_GE(MEDfieldValueWithProfileWr(file, name, step, MED_NO_IT, step, entity, kind, MED_COMPACT_STMODE, profile,
                                       MED_NO_LOCALIZATION, MED_FULL_INTERLACE, MED_ALL_CONSTITUENT, count,
                                       reinterpret_cast<const unsigned char*>(values.data())),
            0);
  ASSERT_EQ(values.size(), static_cast<std::size_t>(count * components));
}

/// A unit cube, as a hexahedron, with an adjacent tet and pyramid. Point field "t" is x + 2 y + 3 z, ten times that at
/// the second step; cell field "p" is 5 in the hexahedron and 6 in the tet; "u" is a vector at the nodes.
void write_bar(const std::string& name) {
  const med_idt file = MEDfileOpen(name.c_str(), MED_ACC_CREAT);
  ASSERT_GE(file, 0);
  std::string axes = "x               y               z               ", units(48, ' ');
  ASSERT_GE(MEDmeshCr(file, mesh_name, 3, 3, MED_UNSTRUCTURED_MESH, "a test", "s", MED_SORT_DTIT, MED_CARTESIAN,
                      axes.c_str(), units.c_str()),
            0);
  const std::vector<med_float> points = {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0, 0, 0, 1, 1,   0,   1,
                                         1, 1, 1, 0, 1, 1, 2, 0, 0, 2, 1, 0, 2, 0, 1, 0.5, 0.5, 4};
  ASSERT_GE(MEDmeshNodeCoordinateWr(file, mesh_name, MED_NO_DT, MED_NO_IT, 0, MED_FULL_INTERLACE, 12, points.data()),
            0);
  const auto cells = [&](med_geometry_type kind, const std::vector<med_int>& corners) {
    ASSERT_GE(MEDmeshElementConnectivityWr(file, mesh_name, MED_NO_DT, MED_NO_IT, 0, MED_CELL, kind, MED_NODAL,
                                           MED_FULL_INTERLACE, 1, corners.data()),
              0);
  };
  cells(MED_HEXA8, {1, 4, 3, 2, 5, 8, 7, 6});  // faces have MED's orientation, opposite to VTK's
  cells(MED_TETRA4, {2, 9, 10, 11});
  cells(MED_PYRA5, {5, 8, 7, 6, 12});
  cells(MED_TRIA3, {1, 2, 3});
  const std::string component(16, ' '), components(48, ' ');
  ASSERT_GE(MEDfieldCr(file, "t", MED_FLOAT64, 1, component.c_str(), component.c_str(), "s", mesh_name), 0);
  ASSERT_GE(MEDfieldCr(file, "p", MED_FLOAT64, 1, component.c_str(), component.c_str(), "s", mesh_name), 0);
  ASSERT_GE(MEDfieldCr(file, "u", MED_FLOAT64, 3, components.c_str(), components.c_str(), "s", mesh_name), 0);
  for (const int step : {1, 2}) {
    std::vector<double> values;
    for (std::size_t v = 0; v < 12; ++v)
      values.push_back((step == 1 ? 1 : 10) * (points[3 * v] + 2 * points[3 * v + 1] + 3 * points[3 * v + 2]));
    write_field(file, "t", 1, MED_NODE, MED_NONE, step, 12, values);
  }
  write_field(file, "p", 1, MED_CELL, MED_HEXA8, 1, 1, {5});
  write_field(file, "p", 1, MED_CELL, MED_TETRA4, 1, 1, {6});
  const std::vector<med_int> places = {3, 7};
  ASSERT_GE(MEDprofileWr(file, "two", 2, places.data()), 0);
  write_field(file, "u", 3, MED_NODE, MED_NONE, 1, 2, {3, 4, 0, 0, 0, 7}, "two");
  ASSERT_GE(MEDfileClose(file), 0);
}

/// A cube's corners as coordinates of a system of axes.
void write_cube_in(const std::string& name, med_axis_type system, const char* angle_unit, double quarter) {
  const med_idt file = MEDfileOpen(name.c_str(), MED_ACC_CREAT);
  ASSERT_GE(file, 0);
  const std::string axes(48, ' ');
  std::string units(48, ' ');
  units.replace(16, std::string_view(angle_unit).size(), angle_unit);
  ASSERT_GE(MEDmeshCr(file, mesh_name, 3, 3, MED_UNSTRUCTURED_MESH, "a test", "s", MED_SORT_DTIT, system, axes.c_str(),
                      units.c_str()),
            0);
  const std::vector<med_float> points = {1, 0, 0, 3, 0, 0, 3, quarter, 0, 1, quarter, 0,
                                         1, 0, 2, 3, 0, 2, 3, quarter, 2, 1, quarter, 2};
  ASSERT_GE(MEDmeshNodeCoordinateWr(file, mesh_name, MED_NO_DT, MED_NO_IT, 0, MED_FULL_INTERLACE, 8, points.data()), 0);
  const std::vector<med_int> corners = {1, 4, 3, 2, 5, 8, 7, 6};
  ASSERT_GE(MEDmeshElementConnectivityWr(file, mesh_name, MED_NO_DT, MED_NO_IT, 0, MED_CELL, MED_HEXA8, MED_NODAL,
                                         MED_FULL_INTERLACE, 1, corners.data()),
            0);
  ASSERT_GE(MEDfileClose(file), 0);
}

TEST(Med, CylinderCoordinatesAreTurnedToXyz) {
  const test::TemporaryFolder folder;
  for (const auto& [unit, quarter] : {std::pair("rad", std::acos(0.0)), std::pair("", std::acos(0.0)),
                                      std::pair("deg", 90.0), std::pair("degree", 90.0)}) {
    write_cube_in((folder / "a.med").string(), MED_CYLINDRICAL, unit, quarter);
    // The volume is bounded by chords of a quarter of two circles with radii 1 and 3.
    EXPECT_NEAR(testing::volume(read_mesh(folder / "a.med").mesh), 8, 1e-5) << unit;
    std::filesystem::remove(folder / "a.med");
  }
  write_cube_in((folder / "b.med").string(), MED_SPHERICAL, "rad", 1);
  test::expect_bad_input([&] { read_mesh(folder / "b.med"); }, {"b.med", "'bar' is in spherical coordinates"});
}

TEST(Med, CellsAndFieldsAreRead) {
  const test::TemporaryFolder folder;
  write_bar((folder / "bar.med").string());
  ReadOptions options;
  options.field = "t";
  const cells::MeshFile mesh = read_mesh(folder / "bar.med", options);
  EXPECT_EQ(mesh.format, "MED");
  EXPECT_EQ(mesh.counts.cells_read, 3u);  // the triangle is not a volume cell
  EXPECT_NEAR(testing::volume(mesh.mesh), 1 + 1.0 / 6 + 1, 1e-12);
  for (std::size_t v = 0; v < mesh.mesh.positions.size(); ++v) {
    const glm::dvec3& p = mesh.mesh.positions[v];
    EXPECT_EQ(mesh.mesh.scalars[v], 10 * (p.x + 2 * p.y + 3 * p.z));
  }
  options.time_step = 0;
  const cells::MeshFile first = read_mesh(folder / "bar.med", options);
  EXPECT_EQ(*std::ranges::max_element(first.mesh.scalars), 0.5 + 1 + 12);
  options.time_step = 2;
  test::expect_bad_input([&] { read_mesh(folder / "bar.med", options); }, {"bar.med: there is no time step 2"});
}

TEST(Med, CellsWithoutAValueAreBlank) {
  const test::TemporaryFolder folder;
  write_bar((folder / "bar.med").string());
  ReadOptions options;
  options.field = "p";
  const cells::MeshFile cells = read_mesh(folder / "bar.med", options);
  EXPECT_NEAR(testing::volume(cells.mesh), 1 + 1.0 / 6, 1e-12);  // the pyramid has no value
  for (std::size_t t = 0; t < cells.mesh.tets.size(); ++t) {
    const bool of_tet = cells.mesh.positions[cells.mesh.tets[t][0]].x + cells.mesh.positions[cells.mesh.tets[t][1]].x +
                            cells.mesh.positions[cells.mesh.tets[t][2]].x +
                            cells.mesh.positions[cells.mesh.tets[t][3]].x >
                        4;
    EXPECT_EQ(cells.mesh.scalars[t], of_tet ? 6 : 5);
  }
  // Two of twelve nodes have a vector, by a profile.
  const auto u = std::ranges::find(cells.fields, "u", &cells::FieldSummary::name);
  ASSERT_NE(u, cells.fields.end());
  EXPECT_EQ(u->low, 5);
  EXPECT_EQ(u->high, 7);
  EXPECT_EQ(u->nan_count, 10u);
}

/// One cell of second order, whose corners go around the base in MED's orientation.
void write_cell(const std::string& name, const testing::BentCell& cell, med_geometry_type kind) {
  const med_idt file = MEDfileOpen(name.c_str(), MED_ACC_CREAT);
  ASSERT_GE(file, 0);
  const std::string axes = "x               y               z               ", units(48, ' '), component(16, ' ');
  ASSERT_GE(MEDmeshCr(file, mesh_name, 3, 3, MED_UNSTRUCTURED_MESH, "a test", "s", MED_SORT_DTIT, MED_CARTESIAN,
                      axes.c_str(), units.c_str()),
            0);
  std::vector<med_float> points;
  std::vector<med_int> nodes;
  for (const glm::dvec3& p : cell.positions) {
    points.insert(points.end(), {p.x, p.y, p.z});
    nodes.push_back(static_cast<med_int>(nodes.size()) + 1);
  }
  const auto count = static_cast<med_int>(nodes.size());
  ASSERT_GE(MEDmeshNodeCoordinateWr(file, mesh_name, MED_NO_DT, MED_NO_IT, 0, MED_FULL_INTERLACE, count, points.data()),
            0);
  ASSERT_GE(MEDmeshElementConnectivityWr(file, mesh_name, MED_NO_DT, MED_NO_IT, 0, MED_CELL, kind, MED_NODAL,
                                         MED_FULL_INTERLACE, 1, nodes.data()),
            0);
  ASSERT_GE(MEDfieldCr(file, "f", MED_FLOAT64, 1, component.c_str(), component.c_str(), "s", mesh_name), 0);
  write_field(file, "f", 1, MED_NODE, MED_NONE, 1, count, cell.values);
  ASSERT_GE(MEDfileClose(file), 0);
}

TEST(Med, CellsOfSecondOrderHaveTheirVolumeAndTheirField) {
  const std::vector<std::vector<int>> tet10 = {{1, 2}, {2, 3}, {3, 1}, {1, 4}, {2, 4}, {3, 4}},
                                      pyramid13 = {{1, 2}, {2, 3}, {3, 4}, {4, 1}, {1, 5}, {2, 5}, {3, 5}, {4, 5}},
                                      wedge15 = {{1, 2}, {2, 3}, {3, 1}, {4, 5}, {5, 6},
                                                 {6, 4}, {1, 4}, {2, 5}, {3, 6}},
                                      hexahedron20 = {{1, 2}, {2, 3}, {3, 4}, {4, 1}, {5, 6}, {6, 7},
                                                      {7, 8}, {8, 5}, {1, 5}, {2, 6}, {3, 7}, {4, 8}};
  std::vector<std::vector<int>> wedge18 = wedge15, hexahedron27 = hexahedron20;
  wedge18.insert(wedge18.end(), {{1, 2, 5, 4}, {2, 3, 6, 5}, {1, 3, 6, 4}});
  hexahedron27.insert(
      hexahedron27.end(),
      {{1, 2, 3, 4}, {1, 2, 6, 5}, {2, 3, 7, 6}, {3, 4, 8, 7}, {1, 4, 8, 5}, {5, 6, 7, 8}, {1, 2, 3, 4, 5, 6, 7, 8}});
  constexpr auto tet = cells::CurvedFamily::tet, pyramid = cells::CurvedFamily::pyramid,
                 wedge = cells::CurvedFamily::wedge, hexahedron = cells::CurvedFamily::hexahedron;
  const std::vector<std::pair<testing::ReferenceCell, med_geometry_type>> cells = {
      {{"TETRA10", tet, tet10}, MED_TETRA10},
      {{"PYRA13", pyramid, pyramid13, testing::CellSpace::linear}, MED_PYRA13},
      {{"PENTA15", wedge, wedge15}, MED_PENTA15},
      {{"PENTA18", wedge, wedge18}, MED_PENTA18},
      {{"HEXA20", hexahedron, hexahedron20}, MED_HEXA20},
      {{"HEXA27", hexahedron, hexahedron27}, MED_HEXA27}};
  const test::TemporaryFolder folder;
  const ReadOptions options = testing::coarse_options();
  for (const auto& [cell, kind] : cells) {
    SCOPED_TRACE(cell.name);
    const testing::BentCell bent = testing::bend(cell, true);
    write_cell((folder / (cell.name + ".med")).string(), bent, kind);
    testing::expect_same(read_mesh(folder / (cell.name + ".med"), options), bent);
  }
}

/// Two tets over a square of side 2, as stored in version 2.3.6: MED's library reads that version and does not write
/// it. Coordinates and corners are stored one axis or corner after the other.
void write_version_2(const std::string& name) {
  const hid_t access = H5Pcreate(H5P_FILE_ACCESS);
  H5Pset_fclose_degree(access, H5F_CLOSE_STRONG);  // also closes objects open in the file
  const hid_t file = H5Fcreate(name.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, access);
  ASSERT_GE(file, 0);
  const hid_t one = H5Screate(H5S_SCALAR);
  const auto group = [&](const char* path) {
    const hid_t made = H5Gcreate2(file, path, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
    EXPECT_GE(made, 0) << path;
    return made;
  };
  const auto number = [&](hid_t of, const char* attribute, int value) {
    const hid_t made = H5Acreate2(of, attribute, H5T_STD_I32LE, one, H5P_DEFAULT, H5P_DEFAULT);
    EXPECT_GE(H5Awrite(made, H5T_NATIVE_INT, &value), 0) << attribute;
    H5Aclose(made);
  };
  const auto text = [&](hid_t of, const char* attribute, std::string value) {
    const hid_t type = H5Tcopy(H5T_C_S1);
    H5Tset_size(type, value.size() + 1);
    const hid_t made = H5Acreate2(of, attribute, type, one, H5P_DEFAULT, H5P_DEFAULT);
    EXPECT_GE(H5Awrite(made, type, value.c_str()), 0) << attribute;
    H5Aclose(made);
    H5Tclose(type);
  };
  const auto list = [&](const char* path, hid_t stored, hid_t given, hsize_t count, const void* values) {
    const hid_t space = H5Screate_simple(1, &count, nullptr);
    const hid_t made = H5Dcreate2(file, path, stored, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
    EXPECT_GE(H5Dwrite(made, given, H5S_ALL, H5S_ALL, H5P_DEFAULT, values), 0) << path;
    H5Sclose(space);
    return made;
  };
  const hid_t version = group("/INFOS_GENERALES");
  number(version, "MAJ", 2);
  number(version, "MIN", 3);
  number(version, "REL", 6);
  group("/ENS_MAA");
  const hid_t mesh = group("/ENS_MAA/bar");
  number(mesh, "DIM", 3);
  number(mesh, "TYP", 0);
  text(mesh, "DES", "");
  text(mesh, "UNV", "");
  group("/ENS_MAA/bar/NOE");
  group("/ENS_MAA/bar/MAI");
  group("/ENS_MAA/bar/MAI/TE4");
  const std::array<double, 15> points = {0, 2, 0, 2, 0, 0, 0, 2, 2, 0, 0, 0, 0, 0, 3};
  const hid_t nodes = list("/ENS_MAA/bar/NOE/COO", H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, points.size(), points.data());
  number(nodes, "NBR", 5);
  number(nodes, "REP", 0);
  text(nodes, "NOM", "x               y               z               ");
  text(nodes, "UNI", std::string(48, ' '));
  const std::array<int, 8> corners = {1, 3, 2, 2, 3, 4, 5, 5};
  const hid_t tets = list("/ENS_MAA/bar/MAI/TE4/NOD", H5T_STD_I32LE, H5T_NATIVE_INT, corners.size(), corners.data());
  number(tets, "NBR", 2);
  H5Sclose(one);
  EXPECT_GE(H5Fclose(file), 0);
  H5Pclose(access);
}

TEST(Med, VersionTwoIsRead) {
  const test::TemporaryFolder folder;
  write_version_2((folder / "bar.med").string());
  const cells::MeshFile mesh = read_mesh(folder / "bar.med");
  EXPECT_EQ(mesh.counts.cells_read, 2u);
  EXPECT_NEAR(testing::volume(mesh.mesh), 4, 1e-12);  // a square base with an area of 4, and a height of 3
}

TEST(Med, RefusesFilesThatLeadToAnotherDirectory) {
  const test::TemporaryFolder folder;
  std::filesystem::create_directory(folder / "in");
  write_bar((folder / "outside.med").string());
  write_version_2((folder / "in" / "bar.med").string());
  const hid_t file = H5Fopen((folder / "in" / "bar.med").c_str(), H5F_ACC_RDWR, H5P_DEFAULT);
  ASSERT_GE(H5Ldelete(file, "/ENS_MAA", H5P_DEFAULT), 0);
  ASSERT_GE(H5Lcreate_external("../outside.med", "/ENS_MAA", file, "/ENS_MAA", H5P_DEFAULT, H5P_DEFAULT), 0);
  H5Fclose(file);
  test::expect_bad_input([&] { read_mesh(folder / "in" / "bar.med"); },
                         {"bar.med", "refers to 'outside.med', which is neither in its directory nor below"});
}

TEST(Med, RefusesDamagedFilesInOneLine) {
  const test::TemporaryFolder folder;
  write_bar((folder / "bar.med").string());
  const std::string whole = test::contents(folder / "bar.med");
  for (const std::size_t size : {whole.size() - 100, whole.size() / 2, std::size_t{40}}) {
    const auto cut = folder.write("cut.med", whole.substr(0, size));
    test::expect_bad_input([&] { read_mesh(cut); }, {"cut.med: it cannot be opened as HDF5", "; "});
  }
  test::expect_bad_input([&] { read_mesh(folder.write("text.med", "no HDF5")); }, {"text.med: it cannot be opened"});
  test::expect_no_crash_of_changes(folder, "changed.med", whole, [](const auto& file) { read_mesh(file); });
  if (!has_reader(Reader::vtk)) return;  // otherwise no program inspects HDF5
  // For a file with another name, the error names the format and a remedy.
  std::filesystem::copy_file(folder / "bar.med", folder / "bar.h5");
  test::expect_bad_input([&] { read_mesh(folder / "bar.h5"); },
                         {"bar.h5: it is an HDF5 file that contains a MED mesh", ".med"});
}

}  // namespace
}  // namespace tessera::io
