// SPDX-License-Identifier: BSD-3-Clause
// VTKHDF files, written according to VTK's file format documentation.
#include <gtest/gtest.h>
#include <hdf5.h>

#include <array>
#include <string>
#include <vector>

#include "readers/vtk_hdf_files.hpp"
#include "support/mesh_checks.hpp"
#include "support/read_files.hpp"
#include "support/temporary_folder.hpp"

namespace tessera::io::vtk_hdf_test {
namespace {

using testing::HdfWriter;
using testing::write_tets;

TEST(VtkHdf, AnUnstructuredGridIsReadWithItsField) {
  const test::TemporaryFolder folder;
  write_tets(HdfWriter((folder / "a.vtkhdf").string(), "UnstructuredGrid"));
  const cells::MeshFile read = read_mesh(folder / "a.vtkhdf");
  EXPECT_EQ(read.format, "VTKHDF");
  EXPECT_NEAR(testing::volume(read.mesh), 4.0 / 6, 1e-12);
  ASSERT_EQ(read.mesh.scalars.size(), 5u);
  for (std::size_t v = 0; v < 5; ++v) {
    const glm::dvec3& p = read.mesh.positions[v];
    EXPECT_EQ(read.mesh.scalars[v], p.x + 2 * p.y + 3 * p.z);
  }
}

/// Three steps at the times 1.5, 2 and 4. The first has two tets in one part. The second has the two tets as separate
/// parts, twice as large along z. The third has the second's mesh with another field.
void write_steps(const HdfWriter& file) {
  using Int = std::int64_t;
  const auto ints = [&](const char* name, const std::vector<Int>& numbers, hsize_t components = 1) {
    file.data<Int>(name, H5T_NATIVE_INT64, numbers, components);
  };
  ints("NumberOfPoints", {5, 4, 4}), ints("NumberOfCells", {2, 1, 1}), ints("NumberOfConnectivityIds", {8, 4, 4});
  file.data<double>("Points", H5T_NATIVE_DOUBLE,
                    {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, -3,  // the first
                     0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 2, 0, 0, 0,  1, 0, 0, 0, 1, 0, 0, 0, -6},
                    3);
  ints("Connectivity", {0, 1, 2, 3, 0, 2, 1, 4, 0, 1, 2, 3, 0, 2, 1, 3});
  ints("Offsets", {0, 4, 8, 0, 4, 0, 4});
  file.data<std::uint8_t>("Types", H5T_NATIVE_UINT8, {10, 10, 10, 10});
  file.group("PointData"), file.group("CellData"), file.group("Steps");
  file.group("Steps/PointDataOffsets"), file.group("Steps/CellDataOffsets");
  file.data<double>("PointData/f", H5T_NATIVE_DOUBLE,
                    {0, 1, 2, 3, -9, 0, 1, 2, 6, 0, 1, 2, -18, 0, 10, 20, 60, 0, 10, 20, -180});
  file.data<double>("PointData/v", H5T_NATIVE_DOUBLE, std::vector<double>(39, 1), 3);
  file.data<double>("CellData/c", H5T_NATIVE_DOUBLE, {7, 8, 5, 6, 3, 4});
  file.number("Steps", "NSteps", 3);
  file.data<double>("Steps/Values", H5T_NATIVE_DOUBLE, {1.5, 2, 4});
  ints("Steps/NumberOfParts", {1, 2, 2}), ints("Steps/PartOffsets", {0, 1, 1}), ints("Steps/PointOffsets", {0, 5, 5});
  ints("Steps/CellOffsets", {0, 2, 2}, 1), ints("Steps/ConnectivityIdOffsets", {0, 8, 8}, 1);
  ints("Steps/PointDataOffsets/f", {0, 5, 13}), ints("Steps/CellDataOffsets/c", {0, 2, 4});
}

TEST(VtkHdf, EveryStepHasItsOwnPartsPointsAndFields) {
  const test::TemporaryFolder folder;
  write_steps(HdfWriter((folder / "t.vtkhdf").string(), "UnstructuredGrid"));
  for (std::size_t step = 0; step < 3; ++step) {
    SCOPED_TRACE(step);
    ReadOptions options;
    options.time_step = step;
    options.field = "f";
    cells::MeshFile read = read_mesh(folder / "t.vtkhdf", options);
    EXPECT_EQ(read.time_step.count, 3u);
    EXPECT_EQ(read.time_step.step, step);
    EXPECT_EQ(read.time_step.times, (std::vector<double>{1.5, 2, 4}));
    EXPECT_NEAR(testing::volume(read.mesh), step == 0 ? 4.0 / 6 : 8.0 / 6, 1e-12);
    ASSERT_EQ(read.mesh.tets.size(), 2u);
    EXPECT_EQ(read.mesh.scalars.size(), step == 0 ? 5u : 8u);
    for (std::size_t v = 0; v < read.mesh.scalars.size(); ++v) {
      const glm::dvec3& p = read.mesh.positions[v];
      EXPECT_EQ(read.mesh.scalars[v], (step == 2 ? 10 : 1) * (p.x + 2 * p.y + 3 * p.z));
    }
    options.field = "c";
    read = read_mesh(folder / "t.vtkhdf", options);
    const double first = step == 0 ? 7 : step == 1 ? 5 : 3;
    EXPECT_EQ(read.mesh.scalars, (std::vector<double>{first, first + 1}));
  }
  EXPECT_EQ(read_mesh(folder / "t.vtkhdf").time_step.step, 2u);
  ReadOptions options;
  options.time_step = 3;
  test::expect_bad_input([&] { read_mesh(folder / "t.vtkhdf", options); }, {"t.vtkhdf", "no time step 3", "has 3"});
}

TEST(VtkHdf, PartsWithoutStepsAreOneMesh) {
  const test::TemporaryFolder folder;
  {
    const HdfWriter file((folder / "p.vtkhdf").string(), "UnstructuredGrid");
    using Int = std::int64_t;
    file.data<Int>("NumberOfPoints", H5T_NATIVE_INT64, {4, 0, 4});
    file.data<Int>("NumberOfCells", H5T_NATIVE_INT64, {1, 0, 1});
    file.data<Int>("NumberOfConnectivityIds", H5T_NATIVE_INT64, {4, 0, 4});
    file.data<float>("Points", H5T_NATIVE_FLOAT,
                     {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 1, 0, 0, 0, 0, -1}, 3);
    file.data<Int>("Connectivity", H5T_NATIVE_INT64, {0, 1, 2, 3, 0, 1, 2, 3});
    file.data<Int>("Offsets", H5T_NATIVE_INT64, {0, 4, 0, 0, 4});
    file.data<std::uint8_t>("Types", H5T_NATIVE_UINT8, {10, 10});
    file.group("CellData");
    file.data<std::int32_t>("CellData/c", H5T_NATIVE_INT32, {5, 9});
  }
  const cells::MeshFile read = read_mesh(folder / "p.vtkhdf");
  EXPECT_NEAR(testing::volume(read.mesh), 2.0 / 6, 1e-12);
  EXPECT_EQ(read.mesh.scalars, (std::vector<double>{5, 9}));
}

TEST(VtkHdf, StepsThatTheirArraysDoNotHoldAreRefused) {
  const test::TemporaryFolder folder;
  const auto refused = [&](const char* name, const std::vector<std::int64_t>& numbers, const char* part) {
    {
      const HdfWriter file((folder / "d.vtkhdf").string(), "UnstructuredGrid");
      write_steps(file);
      file.replace(name, numbers);
    }
    test::expect_bad_input([&] { read_mesh(folder / "d.vtkhdf"); }, {"d.vtkhdf: VTKHDF: ", part, "damaged"});
  };
  refused("Steps/PartOffsets", {0, 1, 2}, "parts up to 4, but there are only 3");
  refused("Steps/PointOffsets", {0, 5, 6}, "'VTKHDF/Points' has 13 tuples");
  refused("Steps/PointOffsets", {0, 5}, "'Steps/PointOffsets' has no number for step 2");
  refused("Steps/CellOffsets", {0, 2, -1}, "'Steps/CellOffsets' has -1");
  refused("Steps/PointDataOffsets/f", {0, 5, 14}, "'VTKHDF/PointData/f' has 21 tuples");
  refused("NumberOfCells", {2, 1}, "parts");
}

TEST(VtkHdf, OtherTypesAreNamed) {
  const test::TemporaryFolder folder;
  write_tets(HdfWriter((folder / "p.vtkhdf").string(), "PolyData"));
  test::expect_bad_input([&] { read_mesh(folder / "p.vtkhdf"); }, {"p.vtkhdf", "'PolyData'", "save it as"});
}

}  // namespace
}  // namespace tessera::io::vtk_hdf_test
