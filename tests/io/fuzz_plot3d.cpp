// SPDX-License-Identifier: BSD-3-Clause
// Any text gives a PLOT3D grid with valid counts, or none; the input after a NUL is its solution.
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "io/mesh/plot3d_text.hpp"
#include "support/fuzz_check.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace tessera;
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  const std::string_view grid = text.substr(0, text.find('\0'));
  const std::string_view solution = text.substr(grid.size() < size ? grid.size() + 1 : size);
  test::parse_or_refuse([&] {
    const auto layout = io::plot3d_text_layout(grid, "f.xyz");
    if (!layout) return;
    std::size_t numbers = 0;
    for (const auto& n : layout->grids)
      numbers += 3 * static_cast<std::size_t>(n[0]) * static_cast<std::size_t>(n[1]) * static_cast<std::size_t>(n[2]);
    test::require(2 * numbers <= grid.size() + 1);  // at least a digit and a blank each
    io::check_plot3d_text_solution(solution, *layout, "f.q");
  });
  return 0;
}
