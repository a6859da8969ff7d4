// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <gtest/gtest.h>
#include <vtk_netcdf.h>

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

namespace tessera::test {

/// A file being written; every call must succeed.
class NetcdfWriter {
 public:
  NetcdfWriter(const std::filesystem::path& file, int mode) {
    EXPECT_EQ(nc_create(file.c_str(), NC_CLOBBER | mode, &id_), NC_NOERR);
  }
  /// A group of another writer's file, which the other one closes.
  NetcdfWriter(const NetcdfWriter& parent, const char* group) : owns_(false) {
    EXPECT_EQ(nc_def_grp(parent.id_, group, &id_), NC_NOERR);
  }
  ~NetcdfWriter() {
    if (owns_) {
      EXPECT_EQ(nc_close(id_), NC_NOERR);
    }
  }
  NetcdfWriter(const NetcdfWriter&) = delete;
  NetcdfWriter& operator=(const NetcdfWriter&) = delete;

  int dimension(const char* name, std::size_t length) {
    int dimension = 0;
    EXPECT_EQ(nc_def_dim(id_, name, length, &dimension), NC_NOERR);
    return dimension;
  }
  int variable(const char* name, nc_type type, const std::vector<int>& dimensions) {
    int variable = 0;
    EXPECT_EQ(nc_def_var(id_, name, type, static_cast<int>(dimensions.size()), dimensions.data(), &variable), NC_NOERR);
    return variable;
  }
  void text(int variable, const char* name, const std::string& value) {
    EXPECT_EQ(nc_put_att_text(id_, variable, name, value.size(), value.c_str()), NC_NOERR);
  }
  void string(int variable, const char* name, const char* value) {
    EXPECT_EQ(nc_put_att_string(id_, variable, name, 1, &value), NC_NOERR);
  }
  void number(int variable, const char* name, nc_type type, const std::vector<double>& values) {
    EXPECT_EQ(nc_put_att_double(id_, variable, name, type, values.size(), values.data()), NC_NOERR);
  }
  void end_definitions() { EXPECT_EQ(nc_enddef(id_), NC_NOERR); }
  void put(int variable, const std::vector<double>& values) {
    EXPECT_EQ(nc_put_var_double(id_, variable, values.data()), NC_NOERR);
  }
  void put(int variable, const std::vector<std::size_t>& first, const std::vector<std::size_t>& counts,
           const std::vector<double>& values) {
    EXPECT_EQ(nc_put_vara_double(id_, variable, first.data(), counts.data(), values.data()), NC_NOERR);
  }

 private:
  int id_ = -1;
  bool owns_ = true;
};

}  // namespace tessera::test
