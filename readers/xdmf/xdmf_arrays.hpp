// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "readers/common/holdings.hpp"

class XdmfArray;
class XdmfBinaryController;

namespace tessera::readers {

/// The files beside an XDMF file that its arrays' numbers lie in.
class XdmfHeavyFiles {
 public:
  explicit XdmfHeavyFiles(const std::filesystem::path& file);

  /// Notes where an array's numbers lie. Throws Error(bad_input) for a file that is not there, or does not lie in the
  /// folder of the XDMF file or below, and for numbers that are to be computed.
  void add(XdmfArray& array);

  /// Memory and time for all of them.
  void allow() const;

 private:
  void require_size(const XdmfBinaryController& numbers, const std::filesystem::path& file) const;

  std::string source_;
  std::filesystem::path folder_;
  std::vector<std::filesystem::path> files_;
};

/// The numbers as doubles; reads them if need be.
std::vector<double> doubles_of(XdmfArray& array);

/// The numbers in their own type; reads them if need be. The tally is of `components`' lengths. The array is empty
/// afterwards, unless it `is_kept`.
io::ForeignArray hold_xdmf(Holdings& holdings, XdmfArray& array, const std::string& name, int components, bool is_kept);

}  // namespace tessera::readers
