// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vtk_netcdf.h>

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

namespace tessera::readers {

struct NetcdfDimension {
  int id = 0;  ///< unique in the file, over all groups
  std::string name;
  std::size_t length = 0;
};

struct NetcdfVariable {
  int group = 0, id = 0;  ///< the library's identifiers
  std::string name;       ///< name without groups
  std::string path;       ///< name with groups: "ocean/temperature"
  nc_type type = NC_NAT;
  std::vector<NetcdfDimension> dimensions;  ///< the first is the slowest
};

/// An open NetCDF file, classic or 4, with all its groups. Throws Error(bad_input) for incomplete files.
class NetcdfFile {
 public:
  explicit NetcdfFile(const std::filesystem::path& file);
  ~NetcdfFile() { nc_close(id_); }
  NetcdfFile(const NetcdfFile&) = delete;
  NetcdfFile& operator=(const NetcdfFile&) = delete;

  /// Numeric variables; those of text or user-defined types are left out.
  [[nodiscard]] const std::vector<NetcdfVariable>& variables() const { return variables_; }

  /// Returns the variable to which another variable refers by name. It is searched for in the group of `from`, then in
  /// the enclosing groups; null if there is none.
  [[nodiscard]] const NetcdfVariable* find(const NetcdfVariable& from, const std::string& name) const;

  /// Returns the numbers of a variable's attribute; empty if it is missing or a text.
  [[nodiscard]] std::vector<double> numbers(const NetcdfVariable& of, const char* attribute) const;

  /// Returns the type of a variable's attribute; NC_NAT if it is missing.
  [[nodiscard]] nc_type attribute_type(const NetcdfVariable& of, const char* attribute) const;

  /// Returns a text attribute of a variable, stored as characters or as one string; empty if it is missing.
  [[nodiscard]] std::string text(const NetcdfVariable& of, const char* attribute) const;

  [[nodiscard]] const std::string& source() const { return source_; }

 private:
  void add_variables(int group, const std::string& path, int depth);

  std::string source_;
  int id_ = -1;
  std::vector<NetcdfVariable> variables_;
};

}  // namespace tessera::readers
