// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <hdf5.h>

#include <array>
#include <cstdint>
#include <string>
#include <vector>

/// VTKHDF files, written according to VTK's file format documentation.
namespace tessera::io::testing {

/// A file with one group, VTKHDF, closed with this object.
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

  [[nodiscard]] hid_t file() const { return file_; }
  [[nodiscard]] hid_t group() const { return group_; }
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
inline void write_tets(const HdfWriter& file) {
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

}  // namespace tessera::io::testing
