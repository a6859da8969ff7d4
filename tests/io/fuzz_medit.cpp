// SPDX-License-Identifier: BSD-3-Clause
// Any bytes give cells with valid indices, or are refused in one line.
#include <cstddef>
#include <cstdint>
#include <span>

#include "io/mesh/medit_file.hpp"
#include "support/fuzz_check.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace tessera;
  test::parse_or_refuse([&] {
    for (const cells::CellBlock& block : io::parse_medit_binary(std::as_bytes(std::span(data, size)), "f.meshb")) {
      test::require(block.offsets.size() == block.types.size() + 1);
      test::require(block.offsets.back() == block.connectivity.size());
      for (const std::uint32_t v : block.connectivity) test::require(v < block.positions.size());
    }
  });
  return 0;
}
