// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>

#include "system/descriptor.hpp"

class vtkDataObject;

namespace tessera::readers {

/// A text file of numbers some of which are NaN or infinite. C++ streams, with which some of VTK's readers read, do not
/// parse these words: placeholders that do not occur in the file replace them until the numbers are read.
class OddNumbers {
 public:
  /// Searches lines that consist of numbers. Finds nothing in a file that is not text.
  explicit OddNumbers(const std::filesystem::path& file);

  [[nodiscard]] bool any() const { return !text_.empty(); }
  /// The file with placeholders; empty if there are none.
  [[nodiscard]] const std::string& text() const { return text_; }
  /// The name of a file in memory with this text, valid during the lifetime of this object; without such numbers the
  /// file itself.
  [[nodiscard]] std::string file_name();
  /// Replaces the placeholders in the data that was read.
  void restore(vtkDataObject* data) const;

 private:
  std::filesystem::path file_;
  std::string text_;
  system::Descriptor in_memory_;
};

}  // namespace tessera::readers
