// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <algorithm>
#include <string>

#include "tessera/dataset.hpp"
#include "tessera/error.hpp"
#include "tessera/program/nearest_name.hpp"
#include "tessera/program/render_options.hpp"

namespace tessera {
inline namespace v0_1 {

void apply_method_preset(int ranks, OptionWords& words) {
  if (!words.given("preset")) return;
  if (const auto colors = nearest_name(words.word("preset"), preset_names()))  // other programs call these presets
    throw bad_input(
        fmt::format("`preset`: '{}' is not the preset of a published method; for colours write `transfer_function` {}",
                    words.word("preset"), *colors));
  static_cast<void>(words.choice("preset"));
  words.set_default("rasterizer", "scanline");
  // An accuracy is only valid with `auto`, so a given accuracy selects that method.
  if (!words.given("accuracy")) words.set_default("integrator", "sampled:4");
  words.set_default("compositor", "gl-fragment");
  if (words.word("compositor") != "cpu") words.set_default("backend", "osmesa");
  if (words.word("compositor") == "gl-fragment") words.set_default("framebuffer", "half");
  // Sixteen tiles along the longer side of the image.
  const ImageSize size = words.size("size").value_or(ImageSize());
  words.set_default("tile-size", std::to_string(std::min((std::max(size.width, size.height) + 15) / 16, 1024)));
  if (ranks < 2) return;
  words.set_default("exchange", "segments");
  words.set_default("without", "sharing");
  if (!words.given("compositors")) words.set_default("projectors", std::to_string((ranks + 1) / 2));
}

}  // namespace v0_1
}  // namespace tessera
