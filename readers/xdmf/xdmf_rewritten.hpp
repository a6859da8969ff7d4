// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>

namespace tessera::readers {

/// An XDMF file's text in the words of Xdmf's library: elements that stand for others by Reference include these,
/// attributes without a name or center have the default ones, items without a format have their numbers in the text,
/// and lists of times are their grids'. Throws Error(bad_input) for a reference to what is not there.
std::string rewritten_xdmf(const std::filesystem::path& file);

/// The current folder of the process while this lives, unless `folder` is empty.
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
