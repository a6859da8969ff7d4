// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>

#include "tessera/dataset.hpp"
#include "tessera/export.hpp"

/// Identification of a file before it is opened as a data set (docs/FORMATS.md).
namespace tessera {
inline namespace v0_1 {

/// The identity of a file or directory, determined once from its first bytes: a .vtk may be a mesh or a grid, and a
/// file may have the wrong extension. The name is only used if the contents do not identify the format. The object does
/// not keep the file open. Copies share the result. If the file changes, it must be identified again.
class TESSERA_EXPORT InputFile {
 public:
  /// A missing file is identified by its name alone; opening it reports the error. Throws Error(bad_input) for a file
  /// that is empty or cannot be read, for a directory that is not a data set, and for the name of a time series.
  explicit InputFile(const std::filesystem::path& file);

  [[nodiscard]] const std::filesystem::path& path() const;

  /// Whether Dataset::open() would open the file as a grid. The contents of NetCDF, HDF5 and XDMF files are read on the
  /// first call.
  [[nodiscard]] bool opens_as_grid(const ReadOptions& options = {}) const;

  /// Whether the file can be opened as a mesh. Rectilinear grids can be opened as grids and as meshes.
  [[nodiscard]] bool opens_as_mesh() const;

  struct Found;  ///< incomplete for callers

 private:
  friend struct StateAccess;
  std::shared_ptr<const Found> found_;
};

/// Throws Error(bad_input) unless the input exists: a file, or at least one step of a time series. Programs should call
/// this function before they report errors about the kind of the input, which would be misleading if the file does not
/// exist.
TESSERA_EXPORT void require_input(const std::filesystem::path& input);

/// Both functions throw Error(bad_input) if the file does not exist. They also throw it if the file's name and first
/// bytes show that it is not a grid (require_grid) or not a mesh (require_mesh). The rest of the file is not read.
TESSERA_EXPORT void require_grid(const std::filesystem::path& file);
TESSERA_EXPORT void require_mesh(const std::filesystem::path& file);

/// Returns the contents of the file. Throws Error(bad_input) unless it is a readable regular file that is not empty.
TESSERA_EXPORT std::string read_text(const std::filesystem::path& file);

/// Throws Error(bad_input, "SOURCE: line L, column C: ...") unless `text` is unambiguous JSON: without duplicate keys
/// in an object and without numbers beyond the range of double, with at most 64 levels and at most `most_values`
/// values, counting objects and lists too. Takes linear time.
TESSERA_EXPORT void check_json(std::string_view text, const std::string& source, std::size_t most_values = 20'000'000);

}  // namespace v0_1
}  // namespace tessera
