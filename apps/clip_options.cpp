#include "apps/clip_options.hpp"

#include <fmt/format.h>

#include <array>
#include <glm/common.hpp>

#include "apps/argument_values.hpp"
#include "tessera/error.hpp"

namespace tessera::apps {
namespace {

/// `count` numbers with commas between.
template <std::size_t count>
std::array<double, count> numbers(const std::string& option, const std::string& given, const std::string& text,
                                  const char* takes) {
  std::array<double, count> values{};
  std::size_t at = 0;
  for (std::size_t k = 0; k < count; ++k) {
    const std::size_t comma = text.find(',', at);
    if ((comma == std::string::npos) != (k + 1 == count))
      throw bad_input(fmt::format("{}: '{}' is not {}", option, given, takes));
    values[k] = parse_number(option, text.substr(at, comma - at));
    at = comma + 1;
  }
  return values;
}

}  // namespace

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
      const auto n = numbers<6>("--clip", text, text.substr(box.size()), "box:X0,Y0,Z0,X1,Y1,Z1");
      const glm::dvec3 a(n[0], n[1], n[2]), b(n[3], n[4], n[5]);
      const Box sides{glm::min(a, b), glm::max(a, b)};
      if (sides.low.x == sides.high.x || sides.low.y == sides.high.y || sides.low.z == sides.high.z)
        throw bad_input(fmt::format("--clip: '{}' is flat; give two opposite corners of a box", text));
      const auto kept = half_spaces_of(sides);
      selection.clip.insert(selection.clip.end(), kept.begin(), kept.end());
    } else {
      const auto n = numbers<6>("--clip", text, text, "PX,PY,PZ,NX,NY,NZ, a point and a normal");
      selection.clip.push_back({{n[0], n[1], n[2]}, {n[3], n[4], n[5]}});
      if (selection.clip.back().normal == glm::dvec3(0))
        throw bad_input(fmt::format("--clip: '{}' has the normal 0,0,0; say which side is to be kept", text));
    }
  }
  if (!words.threshold.empty()) {
    selection.threshold = numbers<2>("--threshold", words.threshold, words.threshold, "MIN,MAX");
    if ((*selection.threshold)[0] > (*selection.threshold)[1])
      throw bad_input(fmt::format("--threshold: '{}' is no range; give the smaller number first", words.threshold));
  }
  return selection;
}

}  // namespace tessera::apps
