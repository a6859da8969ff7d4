// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <mutex>

#include "io/files/input_file.hpp"
#include "tessera/input_file.hpp"

namespace tessera {
inline namespace v0_1 {

struct TESSERA_HIDDEN InputFile::Found {
  explicit Found(const std::filesystem::path& path);
  /// The result of io::is_volume(), which is computed once.
  [[nodiscard]] bool is_volume() const;

  bool is_there;
  io::InputFile file;  ///< identified by its name alone if the file is missing

 private:
  mutable std::once_flag once_;
  mutable bool is_volume_ = false;
};

}  // namespace v0_1
}  // namespace tessera
