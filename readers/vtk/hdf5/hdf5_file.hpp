// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "readers/common/hdf5_handle.hpp"
#include "readers/vtk/grid_numbers.hpp"

namespace tessera::readers {

/// An array of numbers in a file. Their type is convertible to one of ours; the first axis is the slowest.
struct Hdf5Array {
  std::string path;  ///< "exchange/data"
  NumberType type = NumberType::float64;
  std::vector<std::size_t> lengths;
};

/// An open HDF5 file. Supports lzf, a filter of h5py.
class Hdf5File {
 public:
  explicit Hdf5File(const std::filesystem::path& file);

  [[nodiscard]] bool is_open() const { return file_.is_open(); }
  [[nodiscard]] bool has(const char* name) const { return H5Lexists(file_.get(), name, H5P_DEFAULT) > 0; }
  [[nodiscard]] bool has_attribute(const char* name) const { return H5Aexists(file_.get(), name) > 0; }

  /// Returns the text of an attribute of a group or an array; empty if it is missing.
  [[nodiscard]] std::string text_of(const char* object, const char* name) const;

  /// Returns the value of a numeric attribute, or `otherwise` if it is missing.
  [[nodiscard]] long number_of(const char* object, const char* name, long otherwise) const;

  /// Returns the numbers of an attribute; empty if it is missing or a text.
  [[nodiscard]] std::vector<double> numbers_of(const char* object, const char* name) const;

  /// Returns all arrays of numbers in the file, or in a group and its subgroups, sorted by path. Does not follow links
  /// to other files.
  [[nodiscard]] std::vector<Hdf5Array> arrays(const std::string& group = "/") const;

  /// Whether an array has dimension scales, which NetCDF's library creates for its dimensions.
  [[nodiscard]] bool has_scales(const Hdf5Array& array) const;

  /// Reads the numbers from index `first` on, `counts` along each axis. Throws Error(bad_input) if they cannot be read.
  [[nodiscard]] GridNumbers read(const Hdf5Array& array, std::span<const std::size_t> first,
                                 std::span<const std::size_t> counts) const;

 private:
  [[nodiscard]] std::optional<Hdf5Array> array_at(const std::string& path) const;

  std::string source_;
  Hdf5Handle file_;
};

}  // namespace tessera::readers
