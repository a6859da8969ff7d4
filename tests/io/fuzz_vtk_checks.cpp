// libFuzzer target for the walk over legacy VTK text that runs before VTK's own reader: it ends, in Error or not.
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "io/vtk_checks.hpp"
#include "scene/error.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  try {
    tessera::io::check_vtk_legacy(std::string_view(reinterpret_cast<const char*>(data), size), "fuzz.vtk");
  } catch (const tessera::scene::Error&) {
  }
  return 0;
}
