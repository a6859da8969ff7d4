// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>

#include "tessera/dataset.hpp"
#include "tessera/export.hpp"

/// What a file is, before it is opened as a data set (docs/FORMATS.md).
namespace tessera {
inline namespace v0_1 {

/// A file or folder, opened once and identified: by what it begins with, so that a .vtk may be a mesh or a grid and a
/// name may be wrong; by its name where that says nothing. Keeps no file open; copies share what was found. A file that
/// changes has to be identified again.
class TESSERA_EXPORT InputFile {
 public:
  /// A file that is not there is identified by its name alone; opening it reports that. Throws Error(bad_input) for one
  /// that cannot be read or is empty, a folder that does not stand for a file, and the name of a time series.
  explicit InputFile(const std::filesystem::path& file);

  [[nodiscard]] const std::filesystem::path& path() const;

  /// Whether Dataset::open would make a grid of it. NetCDF, HDF5 and XDMF files are looked into when this is first
  /// asked.
  [[nodiscard]] bool opens_as_grid(const ReadOptions& options = {}) const;

  /// Whether it can be opened as a mesh. Rectilinear grids can be opened as either.
  [[nodiscard]] bool opens_as_mesh() const;

  struct Found;  ///< incomplete for callers

 private:
  friend struct StateAccess;
  std::shared_ptr<const Found> found_;
};

/// Throws Error(bad_input) unless the input is there: a file, or of a time series at least one step. For what must not
/// be said of a file that is not there, such as that it is a mesh.
TESSERA_EXPORT void require_input(const std::filesystem::path& input);

/// Throws Error(bad_input) if the file is not there, or by its name or beginning no grid (no mesh). Does not read it.
TESSERA_EXPORT void require_grid(const std::filesystem::path& file);
TESSERA_EXPORT void require_mesh(const std::filesystem::path& file);

/// All of a file. Throws Error(bad_input) unless it is a readable regular file that is not empty.
TESSERA_EXPORT std::string read_text(const std::filesystem::path& file);

/// Throws Error(bad_input, "SOURCE: line L, column C: ...") unless `text` is JSON that reads as it is meant: no key
/// twice in one object, no number beyond double's range, at most 64 levels and `most_values` values, of which objects
/// and lists count too. Takes linear time.
TESSERA_EXPORT void check_json(std::string_view text, const std::string& source, std::size_t most_values = 20'000'000);

}  // namespace v0_1
}  // namespace tessera
