// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>

#include "system/descriptor.hpp"

class vtkDataObject;

namespace tessera::readers {

/// A text file of numbers, some of which are NaN or infinite. Some of VTK's readers read numbers with C++ streams,
/// which do not parse these words. Placeholders that do not occur in the file therefore replace the words until the
/// numbers have been read.
class OddNumbers {
 public:
  /// Searches the lines that consist of numbers. A file that is not text is not searched.
  explicit OddNumbers(const std::filesystem::path& file);

  [[nodiscard]] bool any() const { return !text_.empty(); }
  /// The text of the file with placeholders; empty if the file has no NaN or infinite numbers.
  [[nodiscard]] const std::string& text() const { return text_; }
  /// Returns the name of a file in memory with this text, which is valid during the lifetime of this object. If the
  /// file has no NaN or infinite numbers, returns the name of the file itself.
  [[nodiscard]] std::string file_name();
  /// In data that were read, replaces the placeholders by NaN or infinity.
  void restore(vtkDataObject* data) const;

 private:
  std::filesystem::path file_;
  std::string text_;
  system::Descriptor in_memory_;
};

}  // namespace tessera::readers
