// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>

#include "system/descriptor.hpp"

class vtkDataObject;

namespace tessera::readers {

/// A text file of numbers some of which are NaN or infinite. C++ streams, by which some of VTK's readers read, do not
/// know these words: others stand in for them, which no file has, until the numbers are read.
class OddNumbers {
 public:
  /// Looks for such numbers in lines of numbers alone. Nothing of a file that is not text.
  explicit OddNumbers(const std::filesystem::path& file);

  [[nodiscard]] bool any() const { return !text_.empty(); }
  /// The file with other numbers in their places; empty if there are none.
  [[nodiscard]] const std::string& text() const { return text_; }
  /// The name of a file in memory that has this text, for as long as this lives; without such numbers the file itself.
  [[nodiscard]] std::string file_name();
  /// Puts the numbers back into what was read.
  void restore(vtkDataObject* data) const;

 private:
  std::filesystem::path file_;
  std::string text_;
  system::Descriptor in_memory_;
};

}  // namespace tessera::readers
