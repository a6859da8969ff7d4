// libFuzzer target for TetGen's text files: the input, cut at its first NUL, is a .node and a .ele, a .poly or a
// .smesh.
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "io/tetgen_files.hpp"
#include "scene/error.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace tessera::io;
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  const std::string_view first = text.substr(0, text.find('\0')),
                         second = first.size() < size ? text.substr(first.size() + 1) : text.substr(size);
  try {
    const CellBlock block = parse_node_ele(first, second, "fuzz.node", "fuzz.ele");
    for (const std::uint32_t v : block.connectivity)
      if (v >= block.positions.size()) std::abort();
  } catch (const tessera::scene::Error&) {
  }
  for (const bool smesh : {false, true}) {
    try {
      const Surface surface = parse_tetgen_surface(first, smesh, second, "fuzz.poly", "fuzz.node");
      for (const Facet& facet : surface.facets)
        for (const Polygon& polygon : facet.polygons)
          for (const std::uint32_t v : polygon)
            if (v >= surface.points.size()) std::abort();
    } catch (const tessera::scene::Error&) {
    }
  }
  return 0;
}
