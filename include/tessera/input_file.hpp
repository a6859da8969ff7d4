// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>

#include "tessera/dataset.hpp"
#include "tessera/export.hpp"

/// The kind of a file, before it is opened as a data set (docs/FORMATS.md).
namespace tessera {
inline namespace v0_1 {

/// A file or directory, opened once and identified by its first bytes, so that a .vtk may be a mesh or a grid and a
/// file may have the wrong extension. The name decides if the contents do not. Keeps no file open; copies share the
/// result. A file that changes must be identified again.
class TESSERA_EXPORT InputFile {
 public:
  /// A missing file is identified by its name alone; opening it reports the error. Throws Error(bad_input) for a file
  /// that cannot be read or is empty, a directory that does not represent a data set, and the name of a time series.
  explicit InputFile(const std::filesystem::path& file);

  [[nodiscard]] const std::filesystem::path& path() const;

  /// Whether Dataset::open would open it as a grid. The contents of NetCDF, HDF5 and XDMF files are read on the first
  /// call.
  [[nodiscard]] bool opens_as_grid(const ReadOptions& options = {}) const;

  /// Whether it can be opened as a mesh. Rectilinear grids can be opened as either.
  [[nodiscard]] bool opens_as_mesh() const;

  struct Found;  ///< incomplete for callers

 private:
  friend struct StateAccess;
  std::shared_ptr<const Found> found_;
};

/// Throws Error(bad_input) unless the input exists: a file, or at least one step of a time series. Call it before
/// messages about the input's kind, which make no sense for a missing file.
TESSERA_EXPORT void require_input(const std::filesystem::path& input);

/// Throws Error(bad_input) if the file is missing, or is not a grid (a mesh) by its name or beginning. Does not read
/// it.
TESSERA_EXPORT void require_grid(const std::filesystem::path& file);
TESSERA_EXPORT void require_mesh(const std::filesystem::path& file);

/// The whole file. Throws Error(bad_input) unless it is a readable regular file that is not empty.
TESSERA_EXPORT std::string read_text(const std::filesystem::path& file);

/// Throws Error(bad_input, "SOURCE: line L, column C: ...") unless `text` is unambiguous JSON: no duplicate keys in one
/// object, no number beyond double's range, at most 64 levels and `most_values` values, including objects and lists.
/// Takes linear time.
TESSERA_EXPORT void check_json(std::string_view text, const std::string& source, std::size_t most_values = 20'000'000);

}  // namespace v0_1
}  // namespace tessera
