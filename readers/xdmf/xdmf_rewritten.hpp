// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>

namespace tessera::readers {

/// Returns an XDMF file's text in a form that Xdmf's library supports: copies of the target replace elements that refer
/// to it by Reference, attributes without a name or center get the defaults, items without a format have their numbers
/// in the text, and lists of times are distributed to their grids. Throws Error(bad_input) for a reference to a missing
/// element.
std::string rewritten_xdmf(const std::filesystem::path& file);

/// Changes the current directory of the process during the lifetime of this object, unless `folder` is empty.
class CurrentFolder {
 public:
  explicit CurrentFolder(const std::filesystem::path& folder);
  ~CurrentFolder();
  CurrentFolder(const CurrentFolder&) = delete;
  CurrentFolder& operator=(const CurrentFolder&) = delete;

 private:
  std::filesystem::path before_;
};

}  // namespace tessera::readers
