// The walks over legacy VTK and NetCDF headers that run before the libraries' readers end, in a refusal or not.
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "fuzz_check.hpp"
#include "io/vtk_checks.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace tessera;
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  test::parse_or_refuse([&] { io::check_vtk_legacy(text, "f"); });
  test::parse_or_refuse([&] { io::check_netcdf_classic(text, "f"); });
  return 0;
}
