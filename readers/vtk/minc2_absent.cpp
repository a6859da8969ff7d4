// SPDX-License-Identifier: BSD-3-Clause
// Built instead of minc2_file.cpp if TESSERA_MINC=OFF.
#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "readers/common/readers.hpp"

namespace tessera::readers {

io::ForeignContents read_minc2(Holdings&, const std::filesystem::path& file, const nlohmann::json&) {
  throw scene::bad_input(
      fmt::format("{}: MINC 2 files need MINC's library, which this build leaves out; build with TESSERA_MINC=ON, or "
                  "convert it with mnc2nii",
                  file.string()));
}

}  // namespace tessera::readers
