// SPDX-License-Identifier: BSD-3-Clause
// Any bytes give a surface with valid indices, or are refused in one line.
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "io/mesh/ply_file.hpp"
#include "support/fuzz_check.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace tessera;
  test::parse_or_refuse([&] {
    const io::PlySurface ply = io::parse_ply(std::string_view(reinterpret_cast<const char*>(data), size), "f");
    for (const cells::Facet& facet : ply.surface.facets)
      for (const std::uint32_t v : facet.polygons.front()) test::require(v < ply.surface.points.size());
    test::require(ply.attribute_names.size() == ply.surface.attributes.size());
    for (const auto& values : ply.surface.attributes) test::require(values.size() == ply.surface.points.size());
  });
  return 0;
}
