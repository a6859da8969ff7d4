// SPDX-License-Identifier: BSD-3-Clause
// Any text is parsed as a transfer function or refused in one line.
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "io/scene/transfer_function_file.hpp"
#include "support/fuzz_check.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace tessera;
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  test::parse_or_refuse([&] {
    const auto loaded = io::parse_text_transfer_function(text, "f", {});
    for (const scene::Knot& knot : loaded.function.knots())
      test::require(std::isfinite(knot.value) && knot.extinction >= 0 && std::isfinite(knot.extinction));
    const auto knots = loaded.function.knots();
    test::require(!knots.empty() && !std::isnan(loaded.function.evaluate(knots.front().value).extinction));
  });
  return 0;
}
