// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "readers/common/holdings.hpp"

class XdmfArray;
class XdmfBinaryController;

namespace tessera::readers {

/// The files to which an XDMF file refers, which contain the numbers of its arrays.
class XdmfHeavyFiles {
 public:
  explicit XdmfHeavyFiles(const std::filesystem::path& file);

  /// Records where the numbers of an array are. Throws Error(bad_input) for a file that is missing, or is not in the
  /// XDMF file's directory or below, and for numbers that must be computed.
  void add(XdmfArray& array);

  /// Raises the limits of memory and time for all of these files.
  void allow() const;

 private:
  void require_size(const XdmfBinaryController& numbers, const std::filesystem::path& file) const;

  std::string source_;
  std::filesystem::path folder_;
  std::vector<std::filesystem::path> files_;
};

/// Returns the numbers of an array as doubles, after reading them if necessary.
std::vector<double> doubles_of(XdmfArray& array);

/// Adds an array with its numbers in their own type, after reading them if necessary. If there are several
/// `components`, the tally counts the lengths of the vectors. `array` is empty afterwards, unless it `is_kept`.
io::ForeignArray hold_xdmf(Holdings& holdings, XdmfArray& array, const std::string& name, int components, bool is_kept);

}  // namespace tessera::readers
