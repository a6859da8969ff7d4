// SPDX-License-Identifier: BSD-3-Clause
// Files referenced by HDF5 files: by links, external storage and virtual datasets.
#include <gtest/gtest.h>
#include <hdf5.h>
#include <sys/stat.h>

#include <array>
#include <string>

#include "readers/vtk_hdf_files.hpp"
#include "support/mesh_checks.hpp"
#include "support/read_files.hpp"
#include "support/temporary_folder.hpp"

namespace tessera::io {
namespace {

using testing::HdfWriter;
using testing::write_tets;

/// The directory `in` of a temporary one, with a file of two tets in both.
class Hdf5References : public ::testing::Test {
 protected:
  Hdf5References() : in(folder / "in") {
    std::filesystem::create_directory(in);
    for (const auto& file : {in / "tets.vtkhdf", folder / "outside.vtkhdf"})
      write_tets(HdfWriter(file.string(), "UnstructuredGrid"));
  }

  /// A file whose group VTKHDF is a link to that of another one.
  [[nodiscard]] std::filesystem::path linked(const std::string& name, const std::string& to) const {
    const auto file = in / name;
    const hid_t made = H5Fcreate(file.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT);
    H5Lcreate_external(to.c_str(), "/VTKHDF", made, "VTKHDF", H5P_DEFAULT, H5P_DEFAULT);
    H5Fclose(made);
    return file;
  }

  /// The tets with a field that is a virtual dataset of five numbers.
  [[nodiscard]] std::filesystem::path with_virtual_field(const std::string& name, const char* file,
                                                         const char* dataset) const {
    const HdfWriter writer((in / name).string(), "UnstructuredGrid");
    write_tets(writer);
    const hsize_t five = 5;
    const hid_t space = H5Screate_simple(1, &five, nullptr), creation = H5Pcreate(H5P_DATASET_CREATE);
    H5Pset_virtual(creation, space, file, dataset, space);
    H5Dclose(H5Dcreate2(writer.group(), "PointData/g", H5T_NATIVE_DOUBLE, space, H5P_DEFAULT, creation, H5P_DEFAULT));
    H5Pclose(creation), H5Sclose(space);
    return in / name;
  }

  /// The same with a field that is the bytes of another file.
  [[nodiscard]] std::filesystem::path with_external_field(const std::string& name, const char* file) const {
    const HdfWriter writer((in / name).string(), "UnstructuredGrid");
    write_tets(writer);
    const hsize_t five = 5;
    const hid_t space = H5Screate_simple(1, &five, nullptr), creation = H5Pcreate(H5P_DATASET_CREATE);
    H5Pset_external(creation, file, 0, 40);
    H5Dclose(H5Dcreate2(writer.group(), "PointData/g", H5T_NATIVE_DOUBLE, space, H5P_DEFAULT, creation, H5P_DEFAULT));
    H5Pclose(creation), H5Sclose(space);
    return in / name;
  }

  static void expect_refused(const std::filesystem::path& file, const std::string& words) {
    test::expect_bad_input([&] { read_mesh(file); }, {file.string(), words});
  }

  test::TemporaryFolder folder;
  std::filesystem::path in;
};

TEST_F(Hdf5References, ToNeighbouringFilesAreFollowed) {
  EXPECT_NEAR(testing::volume(read_mesh(linked("a.vtkhdf", "tets.vtkhdf")).mesh), 4.0 / 6, 1e-12);
  ReadOptions options;
  options.field = "g";
  const cells::MeshFile read = read_mesh(with_virtual_field("v.vtkhdf", "tets.vtkhdf", "/VTKHDF/PointData/f"), options);
  EXPECT_EQ(read.mesh.scalars.size(), 5u);
  const cells::MeshFile own = read_mesh(with_virtual_field("w.vtkhdf", ".", "/VTKHDF/PointData/f"), options);
  EXPECT_EQ(own.mesh.scalars, read.mesh.scalars);
}

TEST_F(Hdf5References, ToOtherDirectoriesAreRefused) {
  const std::string outside = (folder / "outside.vtkhdf").string();
  for (const std::string& to : {outside, std::string("../outside.vtkhdf")}) {
    expect_refused(linked("a.vtkhdf", to), "refers to 'outside.vtkhdf', which is neither in its directory nor below");
    expect_refused(with_virtual_field("v.vtkhdf", to.c_str(), "/VTKHDF/PointData/f"),
                   "neither in its directory nor below");
  }
  expect_refused(with_external_field("e.vtkhdf", outside.c_str()), "neither in its directory nor below");
  std::filesystem::create_symlink(outside, in / "link.vtkhdf");
  expect_refused(linked("s.vtkhdf", "link.vtkhdf"), "neither in its directory nor below");
  static_cast<void>(linked("b.vtkhdf", outside));
  expect_refused(linked("c.vtkhdf", "b.vtkhdf"), "in 'b.vtkhdf': it refers to 'outside.vtkhdf'");
}

TEST_F(Hdf5References, ToPipesAreRefused) {
  ASSERT_EQ(::mkfifo((in / "pipe").c_str(), 0600), 0);
  const std::string pipe = (in / "pipe").string();
  expect_refused(linked("a.vtkhdf", "pipe"), "refers to 'pipe', which is not a regular file");
  expect_refused(with_virtual_field("v.vtkhdf", "pipe", "/f"), "not a regular file");
  expect_refused(with_external_field("e.vtkhdf", pipe.c_str()), "not a regular file");
}

// The library recurses until its stack overflows.
TEST_F(Hdf5References, OfVirtualDatasetsToThemselvesAreRefused) {
  expect_refused(with_virtual_field("v.vtkhdf", "v.vtkhdf", "/VTKHDF/PointData/g"), "refer back to themselves");
  expect_refused(with_virtual_field("w.vtkhdf", ".", "/VTKHDF/PointData/g"), "refer back to themselves");
  static_cast<void>(with_virtual_field("x.vtkhdf", "y.vtkhdf", "/VTKHDF/PointData/g"));
  expect_refused(with_virtual_field("y.vtkhdf", "x.vtkhdf", "/VTKHDF/PointData/g"), "refer back to themselves");
}

TEST_F(Hdf5References, ByAPatternOfNamesAreRefused) {
  {
    const HdfWriter writer((in / "p0.vtkhdf").string(), "UnstructuredGrid");
    write_tets(writer);
    const hsize_t five = 5, none = 0, any = H5S_UNLIMITED;
    const hid_t source = H5Screate_simple(1, &five, nullptr), space = H5Screate_simple(1, &five, &any),
                creation = H5Pcreate(H5P_DATASET_CREATE);
    H5Sselect_hyperslab(space, H5S_SELECT_SET, &none, &five, &any, &five);
    H5Pset_virtual(creation, space, "p%b.vtkhdf", "/VTKHDF/PointData/g", source);
    H5Dclose(H5Dcreate2(writer.group(), "PointData/g", H5T_NATIVE_DOUBLE, space, H5P_DEFAULT, creation, H5P_DEFAULT));
    H5Pclose(creation), H5Sclose(space), H5Sclose(source);
  }
  expect_refused(in / "p0.vtkhdf", "given by a pattern");
}

TEST_F(Hdf5References, ToMissingFilesAreLeftToTheLibrary) {
  expect_refused(linked("a.vtkhdf", "gone.vtkhdf"), "it has no cells");
  EXPECT_EQ(read_mesh(with_virtual_field("v.vtkhdf", "gone.vtkhdf", "/f")).mesh.scalars.size(), 5u);
}

}  // namespace
}  // namespace tessera::io
