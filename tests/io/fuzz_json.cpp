// SPDX-License-Identifier: BSD-3-Clause
// Any text is parsed as a ParaView colour map, knots, a ParaView file series or list of PLOT3D files, a JSON camera, or
// refused in one line.
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "io/mesh/plot3d_list.hpp"
#include "io/scene/camera_file.hpp"
#include "io/scene/json_transfer_function.hpp"
#include "io/scene/paraview_color_map.hpp"
#include "io/scene/time_series.hpp"
#include "support/fuzz_check.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace tessera;
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  test::parse_or_refuse([&] { io::parse_json_cameras(text, "f"); });
  test::parse_or_refuse([&] { test::require(!io::parse_file_series(text, "f").empty()); });
  test::parse_or_refuse([&] { test::require(!io::parse_plot3d_list(text, "f").empty()); });
  test::parse_or_refuse([&] {
    colormaps::TransferFunctionOptions options;
    options.field_range = {-3, 1e6};
    const auto loaded = io::parse_paraview_color_map(text, "f", options);
    test::require(loaded.function.max_color() <= 1 + 1e-9);
    test::require(std::isfinite(loaded.function.max_extinction()));
  });
  test::parse_or_refuse([&] {
    const auto loaded = io::parse_json_transfer_function(text, "f", {});
    test::require(std::isfinite(loaded.function.max_extinction()));
  });
  return 0;
}
