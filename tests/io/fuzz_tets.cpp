// libFuzzer target: any bytes either parse into a mesh whose indices hold, or end in Error.
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <span>

#include "io/tets_file.hpp"
#include "scene/error.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  try {
    const auto mesh = tessera::io::parse_tets(std::as_bytes(std::span(data, size)), "fuzz.tets");
    for (const tessera::scene::Tet& tet : mesh.tets)
      for (const std::uint32_t v : tet)
        if (v >= mesh.positions.size()) std::abort();
    if (mesh.scalars.size() != mesh.positions.size()) std::abort();
  } catch (const tessera::scene::Error&) {
  }
  return 0;
}
