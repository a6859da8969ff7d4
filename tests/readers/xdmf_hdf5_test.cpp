// SPDX-License-Identifier: BSD-3-Clause
// XDMF with its numbers in HDF5, written by VTK's library.
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <hdf5.h>

#include <algorithm>
#include <string>
#include <vector>

#include "io/files/reader_programs.hpp"
#include "io/volume/volume_formats.hpp"
#include "support/changed_bytes.hpp"
#include "support/mesh_checks.hpp"
#include "support/read_files.hpp"
#include "support/temporary_folder.hpp"
#include "support/volume_checks.hpp"

namespace tessera::io::xdmf_hdf5_test {
namespace {

template <class T>
void write_set(hid_t file, const char* name, hid_t type, const std::vector<hsize_t>& sizes,
               const std::vector<T>& data) {
  const hid_t space = H5Screate_simple(static_cast<int>(sizes.size()), sizes.data(), nullptr);
  const hid_t set = H5Dcreate2(file, name, type, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
  ASSERT_GE(set, 0);
  ASSERT_GE(H5Dwrite(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, data.data()), 0);
  H5Dclose(set), H5Sclose(space);
}

/// A quadratic tet with straight edges and two values per node: x and 10 x.
void write_data(const std::string& name) {
  const hid_t file = H5Fcreate(name.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT);
  ASSERT_GE(file, 0);
  std::vector<double> places = {0, 0, 0, 2, 0, 0, 0, 2, 0, 0, 0, 2, 1, 0, 0,
                                1, 1, 0, 0, 1, 0, 0, 0, 1, 1, 0, 1, 0, 1, 1};
  std::vector<float> values;
  for (std::size_t v = 0; v < 10; ++v) values.push_back(static_cast<float>(places[3 * v])), values.push_back(0);
  write_set<double>(file, "places", H5T_NATIVE_DOUBLE, {10, 3}, places);
  write_set<std::int64_t>(file, "cells", H5T_NATIVE_INT64, {1, 10}, {0, 1, 2, 3, 4, 5, 6, 7, 8, 9});
  write_set<float>(file, "values", H5T_NATIVE_FLOAT, {10, 2}, values);
  H5Fclose(file);
}

std::string item(const std::string& dimensions, const std::string& type, int precision, const std::string& set) {
  return fmt::format("<DataItem Dimensions=\"{}\" NumberType=\"{}\" Precision=\"{}\" Format=\"HDF\">{}</DataItem>\n",
                     dimensions, type, precision, set);
}

std::string mesh_text(const std::string& data) {
  return "<Xdmf Version=\"3.0\"><Domain><Grid Name=\"m\" GridType=\"Uniform\">\n"
         "<Topology TopologyType=\"Tet_10\" NumberOfElements=\"1\">" +
         item("1 10", "Int", 8, data + ":/cells") + "</Topology>\n<Geometry GeometryType=\"XYZ\">" +
         item("10 3", "Float", 8, data + ":/places") +
         "</Geometry>\n<Attribute Name=\"u\" AttributeType=\"Matrix\" Center=\"Node\">" +
         item("10 2", "Float", 4, data + ":/values") + "</Attribute></Grid></Domain></Xdmf>\n";
}

TEST(XdmfHdf5, ReadsCellsAndFieldsFromTheNeighbouringFile) {
  if (!has_reader(Reader::xdmf)) GTEST_SKIP() << "tessera-read-xdmf is not installed";
  const test::TemporaryFolder folder;
  write_data((folder / "a.h5").string());
  ReadOptions options;
  options.field = "u:0";
  const cells::MeshFile mesh = read_mesh(folder.write("a.xdmf", mesh_text("a.h5")), options);
  EXPECT_EQ(mesh.counts.cells_read, 1u);
  EXPECT_NEAR(testing::volume(mesh.mesh), 8.0 / 6, 1e-12);
  for (const scene::Tet& tet : mesh.mesh.tets)
    for (const std::uint32_t v : tet) EXPECT_EQ(mesh.mesh.scalars[v], mesh.mesh.positions[v].x);
}

TEST(XdmfHdf5, DataThatLeadToAnotherDirectoryAreRefused) {
  if (!has_reader(Reader::xdmf)) GTEST_SKIP() << "tessera-read-xdmf is not installed";
  const test::TemporaryFolder folder;
  const auto in = folder / "in";
  std::filesystem::create_directory(in);
  write_data((folder / "outside.h5").string());
  write_data((in / "a.h5").string());
  const hid_t file = H5Fopen((in / "a.h5").c_str(), H5F_ACC_RDWR, H5P_DEFAULT);
  ASSERT_GE(H5Ldelete(file, "values", H5P_DEFAULT), 0);
  ASSERT_GE(H5Lcreate_external("../outside.h5", "values", file, "values", H5P_DEFAULT, H5P_DEFAULT), 0);
  H5Fclose(file);
  const auto mesh = folder.write("in/a.xdmf", mesh_text("a.h5"));
  test::expect_bad_input([&] { read_mesh(mesh); },
                         {"a.h5", "refers to 'outside.h5', which is neither in its directory nor below"});
}

TEST(XdmfHdf5, DamagedDataAreRefusedInOneLine) {
  if (!has_reader(Reader::xdmf)) GTEST_SKIP() << "tessera-read-xdmf is not installed";
  const test::TemporaryFolder folder;
  write_data((folder / "a.h5").string());
  const std::string whole = test::contents(folder / "a.h5");
  const auto refused = [&](const std::string& text, const std::vector<std::string>& words) {
    const auto file = folder.write("a.xdmf", text);
    test::expect_bad_input([&] { read_mesh(file); }, words);
  };
  refused(mesh_text("b.h5"), {"a.xdmf: its data are in 'b.h5', which does not exist"});
  std::string text = mesh_text("a.h5");
  text.replace(text.find(":/values"), 8, ":/absent");
  refused(text, {"a.xdmf: ", "; "});
  const std::string good = mesh_text("a.h5");
  const auto read = [](const std::filesystem::path& file) { read_mesh(file); };
  test::expect_no_crash_of_changes(folder, "changed.xdmf", good, read);
  const auto file = folder.write("a.xdmf", good);
  test::expect_no_crash_of_changes(folder, "a.h5", whole, [&](const auto&) { read_mesh(file); });
  folder.write("a.h5", whole.substr(0, whole.size() / 2));
  refused(mesh_text("a.h5"), {"a.xdmf: ", "; "});
  folder.write("a.h5", "no HDF5 at all, and not much of it");
  refused(mesh_text("a.h5"), {"a.xdmf: ", "; "});
}

}  // namespace
}  // namespace tessera::io::xdmf_hdf5_test
