// SPDX-License-Identifier: BSD-3-Clause
// TetGen's text files: the input, split at its first NUL, is parsed as a .node and a .ele, a .poly or a .smesh, or
// refused.
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "io/mesh/tetgen_files.hpp"
#include "support/fuzz_check.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace tessera;
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  const std::string_view first = text.substr(0, text.find('\0'));
  const std::string_view second = text.substr(first.size() < size ? first.size() + 1 : size);
  test::parse_or_refuse([&] {
    const cells::CellBlock block = io::parse_node_ele(first, second, "f.node", "f.ele");
    for (const std::uint32_t v : block.connectivity) test::require(v < block.positions.size());
    for (const scene::Tet& tet : block.tets)
      for (const std::uint32_t v : tet) test::require(v < block.positions.size());
  });
  for (const bool smesh : {false, true})
    test::parse_or_refuse([&] {
      const cells::Surface surface = io::parse_tetgen_surface(first, smesh, second, "f.poly", "f.node");
      for (const cells::Facet& facet : surface.facets)
        for (const cells::Polygon& polygon : facet.polygons)
          for (const std::uint32_t v : polygon) test::require(v < surface.points.size());
    });
  return 0;
}
