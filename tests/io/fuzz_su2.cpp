// SPDX-License-Identifier: BSD-3-Clause
// Any text gives zones of cells with valid indices, or is refused in one line.
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "io/mesh/su2_file.hpp"
#include "support/fuzz_check.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace tessera;
  test::parse_or_refuse([&] {
    for (const cells::CellBlock& block : io::parse_su2({reinterpret_cast<const char*>(data), size}, "f.su2")) {
      test::require(block.offsets.size() == block.types.size() + 1);
      test::require(block.offsets.back() == block.connectivity.size());
      for (std::size_t c = 0; c < block.types.size(); ++c) test::require(block.offsets[c] <= block.offsets[c + 1]);
      for (const std::uint32_t v : block.connectivity) test::require(v < block.positions.size());
    }
  });
  return 0;
}
