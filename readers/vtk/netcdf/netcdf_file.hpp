// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vtk_netcdf.h>

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

namespace tessera::readers {

struct NetcdfDimension {
  int id = 0;  ///< unique in the file, whatever its groups
  std::string name;
  std::size_t length = 0;
};

struct NetcdfVariable {
  int group = 0, id = 0;  ///< what the library knows it by
  std::string name;       ///< without its groups
  std::string path;       ///< with them: "ocean/temperature"
  nc_type type = NC_NAT;
  std::vector<NetcdfDimension> dimensions;  ///< the first is the slowest
};

/// An open NetCDF file, classic or 4, with all its groups. Throws Error(bad_input) for files that are not whole.
class NetcdfFile {
 public:
  explicit NetcdfFile(const std::filesystem::path& file);
  ~NetcdfFile() { nc_close(id_); }
  NetcdfFile(const NetcdfFile&) = delete;
  NetcdfFile& operator=(const NetcdfFile&) = delete;

  /// Of numbers; those of text or of the file's own types are left out.
  [[nodiscard]] const std::vector<NetcdfVariable>& variables() const { return variables_; }

  /// The variable that another one names: of its group, else of those around it; null if there is none.
  [[nodiscard]] const NetcdfVariable* find(const NetcdfVariable& from, const std::string& name) const;

  /// Numbers of a variable's attribute; none if it has none, or text.
  [[nodiscard]] std::vector<double> numbers(const NetcdfVariable& of, const char* attribute) const;

  /// The type of a variable's attribute; NC_NAT if it has none.
  [[nodiscard]] nc_type attribute_type(const NetcdfVariable& of, const char* attribute) const;

  /// A variable's attribute that is text, of characters or one string; empty if it has none.
  [[nodiscard]] std::string text(const NetcdfVariable& of, const char* attribute) const;

  [[nodiscard]] const std::string& source() const { return source_; }

 private:
  void add_variables(int group, const std::string& path, int depth);

  std::string source_;
  int id_ = -1;
  std::vector<NetcdfVariable> variables_;
};

}  // namespace tessera::readers
