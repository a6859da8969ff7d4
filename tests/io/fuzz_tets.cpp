// SPDX-License-Identifier: BSD-3-Clause
// Any bytes give a mesh with valid indices, or are refused in one line.
#include <cstddef>
#include <cstdint>
#include <span>

#include "io/mesh/tets_file.hpp"
#include "support/fuzz_check.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace tessera;
  test::parse_or_refuse([&] {
    const scene::TetMesh mesh = io::parse_tets(io::TetsBytes(std::as_bytes(std::span(data, size))), "f");
    for (const scene::Tet& tet : mesh.tets)
      for (const std::uint32_t v : tet) test::require(v < mesh.positions.size());
    test::require(mesh.scalars.size() == mesh.positions.size());
  });
  return 0;
}
