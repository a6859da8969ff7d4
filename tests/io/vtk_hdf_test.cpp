// VTKHDF as VTK's file format documentation has it, written here.
#include <gtest/gtest.h>
#include <hdf5.h>

#include <array>
#include <string>
#include <vector>

#include "io/mesh_checks.hpp"
#include "io/mesh_reader.hpp"
#include "io/temporary_folder.hpp"

namespace tessera::io::vtk_hdf_test {
namespace {

/// A file of one group, VTKHDF.
class HdfWriter {
 public:
  HdfWriter(const std::string& name, const std::string& type)
      : file_(H5Fcreate(name.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT)),
        group_(H5Gcreate2(file_, "VTKHDF", H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT)) {
    const std::array<std::int64_t, 2> version = {1, 0};
    const hsize_t two = 2;
    const hid_t pair = H5Screate_simple(1, &two, nullptr), one = H5Screate(H5S_SCALAR), text = H5Tcopy(H5T_C_S1);
    H5Tset_size(text, type.size());
    const hid_t number = H5Acreate2(group_, "Version", H5T_NATIVE_INT64, pair, H5P_DEFAULT, H5P_DEFAULT);
    H5Awrite(number, H5T_NATIVE_INT64, version.data());
    const hid_t word = H5Acreate2(group_, "Type", text, one, H5P_DEFAULT, H5P_DEFAULT);
    H5Awrite(word, text, type.data());
    H5Aclose(number), H5Aclose(word), H5Sclose(pair), H5Sclose(one), H5Tclose(text);
  }
  ~HdfWriter() {
    H5Gclose(group_);
    H5Fclose(file_);
  }
  HdfWriter(const HdfWriter&) = delete;
  HdfWriter& operator=(const HdfWriter&) = delete;

  void number(const char* group, const char* name, std::int64_t value) const {
    const hid_t of = H5Gopen2(group_, group, H5P_DEFAULT), one = H5Screate(H5S_SCALAR);
    const hid_t attribute = H5Acreate2(of, name, H5T_NATIVE_INT64, one, H5P_DEFAULT, H5P_DEFAULT);
    H5Awrite(attribute, H5T_NATIVE_INT64, &value);
    H5Aclose(attribute), H5Sclose(one), H5Gclose(of);
  }

  void replace(const char* name, const std::vector<std::int64_t>& numbers) const {
    H5Ldelete(group_, name, H5P_DEFAULT);
    data<std::int64_t>(name, H5T_NATIVE_INT64, numbers);
  }

  void group(const char* name) const { H5Gclose(H5Gcreate2(group_, name, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT)); }

  template <class T>
  void data(const char* name, hid_t type, const std::vector<T>& numbers, hsize_t components = 1) const {
    const std::array<hsize_t, 2> sizes = {numbers.size() / components, components};
    const hid_t space = H5Screate_simple(components > 1 ? 2 : 1, sizes.data(), nullptr);
    const hid_t set = H5Dcreate2(group_, name, type, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
    H5Dwrite(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, numbers.data());
    H5Dclose(set), H5Sclose(space);
  }

 private:
  hid_t file_, group_;
};

/// Two tets, on both sides of a face.
void write_tets(const HdfWriter& file) {
  using Int = std::int64_t;
  file.data<Int>("NumberOfPoints", H5T_NATIVE_INT64, {5});
  file.data<Int>("NumberOfCells", H5T_NATIVE_INT64, {2});
  file.data<Int>("NumberOfConnectivityIds", H5T_NATIVE_INT64, {8});
  file.data<double>("Points", H5T_NATIVE_DOUBLE, {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, -3}, 3);
  file.data<Int>("Connectivity", H5T_NATIVE_INT64, {0, 1, 2, 3, 0, 2, 1, 4});
  file.data<Int>("Offsets", H5T_NATIVE_INT64, {0, 4, 8});
  file.data<std::uint8_t>("Types", H5T_NATIVE_UINT8, {10, 10});
  file.group("PointData");
  file.data<double>("PointData/f", H5T_NATIVE_DOUBLE, {0, 1, 2, 3, -9});
}

TEST(VtkHdf, AnUnstructuredGridIsReadWithItsField) {
  const test::TemporaryFolder folder;
  write_tets(HdfWriter((folder / "a.vtkhdf").string(), "UnstructuredGrid"));
  const MeshFile read = read_mesh(folder / "a.vtkhdf");
  EXPECT_EQ(read.format, "VTKHDF");
  EXPECT_NEAR(testing::volume(read.mesh), 4.0 / 6, 1e-12);
  ASSERT_EQ(read.mesh.scalars.size(), 5u);
  for (std::size_t v = 0; v < 5; ++v) {
    const glm::dvec3& p = read.mesh.positions[v];
    EXPECT_EQ(read.mesh.scalars[v], p.x + 2 * p.y + 3 * p.z);
  }
}

/// Three steps at the times 1.5, 2 and 4. The first has two tets in one part. The second has their two halves as parts,
/// twice as large along z. The third has the second's mesh with another field.
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
    MeshOptions options;
    options.time_step = step;
    options.field = "f";
    MeshFile read = read_mesh(folder / "t.vtkhdf", options);
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
  MeshOptions options;
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
  const MeshFile read = read_mesh(folder / "p.vtkhdf");
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
  refused("Steps/PartOffsets", {0, 1, 2}, "parts up to 4, there are 3");
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
