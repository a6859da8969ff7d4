// SPDX-License-Identifier: BSD-3-Clause
// Any text gives zones of cells with valid indices, or is refused in one line.
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "io/mesh/tecplot_file.hpp"
#include "support/fuzz_check.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace tessera;
  test::parse_or_refuse([&] {
    const io::TecplotMesh mesh = io::parse_tecplot({reinterpret_cast<const char*>(data), size}, "f.tec", std::nullopt);
    for (const cells::CellBlock& block : mesh.blocks) {
      test::require(block.offsets.size() == block.types.size() + 1);
      test::require(block.offsets.back() == block.connectivity.size());
      cells::require_faces(block, "f.tec");
      for (const std::uint32_t v : block.connectivity) test::require(v < block.positions.size());
      for (const cells::BlockField& field : block.fields)
        test::require(field.tuples ==
                      (field.association == scene::Association::cell ? block.types.size() : block.positions.size()));
    }
  });
  return 0;
}
