// SPDX-License-Identifier: BSD-3-Clause
#include "apps/options/clip_options.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <glm/common.hpp>

#include "apps/options/argument_values.hpp"
#include "tessera/error.hpp"

namespace tessera::apps {
void add_clip_options(CLI::App& command, ClipWords& words) {
  command
      .add_option("--clip", words.clip,
                  "cut away what lies behind a plane: a point of it and its normal, which points to what stays; or all "
                  "outside of a box; may be repeated")
      ->type_name("PX,PY,PZ,NX,NY,NZ|box:X0,Y0,Z0,X1,Y1,Z1")
      ->allow_extra_args(false);
  command.add_option("--threshold", words.threshold, "keep whole cells whose values are all in this range")
      ->type_name("MIN,MAX");
}

Selection selection_of(const ClipWords& words) {
  Selection selection;
  for (const std::string& text : words.clip) {
    constexpr std::string_view box = "box:";
    if (text.starts_with(box)) {
      const auto n = parse_numbers("--clip", text.substr(box.size()), 6, "box:X0,Y0,Z0,X1,Y1,Z1, six numbers");
      const glm::dvec3 a(n[0], n[1], n[2]), b(n[3], n[4], n[5]);
      const Box sides{glm::min(a, b), glm::max(a, b)};
      if (sides.low.x == sides.high.x || sides.low.y == sides.high.y || sides.low.z == sides.high.z)
        throw bad_input(fmt::format("--clip: '{}' is flat; give two opposite corners of a box", text));
      const auto kept = half_spaces_of(sides);
      selection.clip.insert(selection.clip.end(), kept.begin(), kept.end());
    } else {
      const auto n = parse_numbers("--clip", text, 6, "PX,PY,PZ,NX,NY,NZ, a point and a normal");
      selection.clip.push_back({{n[0], n[1], n[2]}, {n[3], n[4], n[5]}});
      if (selection.clip.back().normal == glm::dvec3(0))
        throw bad_input(fmt::format("--clip: '{}' has the normal 0,0,0; say which side is to be kept", text));
    }
  }
  if (!words.threshold.empty()) {
    const auto ends = parse_numbers("--threshold", words.threshold, 2, "MIN,MAX, two numbers");
    selection.threshold = {{ends[0], ends[1]}};
    if ((*selection.threshold)[0] > (*selection.threshold)[1])
      throw bad_input(fmt::format("--threshold: '{}' is no range; give the smaller number first", words.threshold));
  }
  return selection;
}

}  // namespace tessera::apps
