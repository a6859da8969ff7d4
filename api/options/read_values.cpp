// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <algorithm>
#include <glm/common.hpp>
#include <string_view>

#include "api/options/argument_values.hpp"
#include "api/options/choices.hpp"
#include "api/options/values.hpp"
#include "tessera/error.hpp"
#include "tessera/higher_order.hpp"
#include "tessera/input_file.hpp"
#include "tessera/time_series.hpp"

namespace tessera {
namespace api {
namespace {

Selection selection_of(const OptionWords& words) {
  Selection selection;
  for (const std::string& text : words.words("clip")) {
    constexpr std::string_view box = "box:";
    if (text.starts_with(box)) {
      const auto n = parse_numbers("`clip`", text.substr(box.size()), 6, "box:X0,Y0,Z0,X1,Y1,Z1, six numbers");
      const glm::dvec3 a(n[0], n[1], n[2]), b(n[3], n[4], n[5]);
      const Box sides{glm::min(a, b), glm::max(a, b)};
      if (sides.low.x == sides.high.x || sides.low.y == sides.high.y || sides.low.z == sides.high.z)
        throw bad_input(fmt::format("`clip`: '{}' is flat; give two opposite corners of a box", text));
      const auto kept = half_spaces_of(sides);
      selection.clip.insert(selection.clip.end(), kept.begin(), kept.end());
    } else {
      const auto n = parse_numbers("`clip`", text, 6, "PX,PY,PZ,NX,NY,NZ, a point and a normal");
      selection.clip.push_back({{n[0], n[1], n[2]}, {n[3], n[4], n[5]}});
      if (selection.clip.back().normal == glm::dvec3(0))
        throw bad_input(
            fmt::format("`clip`: '{}' has the normal 0,0,0; give a normal that points to the side to keep", text));
    }
  }
  selection.threshold = words.interval("threshold", true);
  return selection;
}

/// Reads NAME, NAME:FACTOR or `off`.
std::optional<Warp> warp_of(const std::string& word) {
  if (word.empty()) return std::nullopt;
  if (word == "off") return Warp{};
  const std::size_t colon = word.rfind(':');
  if (colon == std::string::npos) return Warp{word};
  const auto fault = [&](const char* what) {
    return bad_input(fmt::format("`warp`: '{}' {}; write NAME, NAME:FACTOR or off", word, what));
  };
  if (colon == 0) throw fault("names no vector");
  try {
    return Warp{word.substr(0, colon), parse_number("`warp`", word.substr(colon + 1))};
  } catch (const Error&) {
    throw fault("has no number after the colon");
  }
}

std::size_t step_number(const std::string& word, int low = 0) {
  return static_cast<std::size_t>(parse_count("`time_step`", word, low, std::numeric_limits<int>::max()));
}

/// Reads WxHxD.
std::optional<GridIndex> dims_of(const std::string& text) {
  if (text.empty()) return std::nullopt;
  GridIndex dims{};
  std::size_t at = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    const std::size_t stop = k < 2 ? text.find('x', at) : text.size();
    if (stop == std::string::npos) throw bad_input(fmt::format("`dims`: '{}' is not three sizes; write WxHxD", text));
    dims[k] = parse_count("`dims`", text.substr(at, stop - at), 1, std::numeric_limits<int>::max());
    at = stop + 1;
  }
  return dims;
}

}  // namespace

std::optional<StepRange> time_steps(const OptionWords& words) {
  const std::string& word = words.word("time-step");
  if (word == "all") return StepRange{};
  const std::size_t colon = word.find(':');
  if (colon == std::string::npos) return std::nullopt;
  StepRange range;
  range.first = step_number(word.substr(0, colon));
  const std::size_t second = word.find(':', colon + 1);
  range.last = step_number(word.substr(colon + 1, second == std::string::npos ? second : second - colon - 1));
  if (second != std::string::npos) range.stride = step_number(word.substr(second + 1), 1);
  if (*range.last < range.first)
    throw bad_input(
        fmt::format("`time_step`: '{}' ends with a step before its first; give the smaller step first", word));
  return range;
}

}  // namespace api

inline namespace v0_1 {

void refuse_time_steps(const OptionWords& words) {
  if (api::time_steps(words))
    throw bad_input(fmt::format("`time_step`: '{}' means a film, which only render can make; give one step",
                                words.word("time-step")));
}

ReadOptions read_options(const OptionWords& words, bool is_grid) {
  ReadOptions read;
  read.grid_as_mesh = !is_grid;
  read.field = words.word("field");
  read.threads = words.count("threads", 1, 1024).value_or(0);
  read.smooth = words.given("smooth");
  read.warp = api::warp_of(words.word("warp"));
  read.plot3d_q = words.word("q");
  read.max_volume = words.positive("max-volume");
  read.axis_scale = words.vector("scale", true);
  if (words.given("time-step") && !api::time_steps(words)) read.time_step = api::step_number(words.word("time-step"));
  read.blocks = words.words("block");
  read.drop_duplicates = words.given("drop-duplicates");
  read.selection = api::selection_of(words);
  assign(read.higher_order_tolerance, words.positive("higher-order-tolerance"));
  assign(read.higher_order_tets, words.count("higher-order-tets", 0));
  read.dims = api::dims_of(words.word("dims"));
  if (words.given("type")) {
    read.type = sample_type_named(words.word("type"));
    if (!read.type)
      throw bad_input(
          fmt::format("`type`: '{}' is unknown; use int8, uint8, int16, uint16, int32, uint32, float32 or float64",
                      words.word("type")));
  }
  read.spacing = words.vector("spacing", true);
  read.origin = words.vector("origin");
  assign(read.big_endian, words.choice("endian", api::off_on));
  assign(read.skip, words.count("skip", 0));
  read.labels = words.choice("labels", api::on_off);
  if (is_grid) {
    read.memory_bytes = words.bytes("memory").value_or(Settings().memory_bytes);
  } else {
    for (const IsoSurface& iso : api::iso_surfaces_of(words)) read.selection.levels.push_back(iso.value);
  }
  return read;
}

InputFile first_input(const OptionWords& words) {
  const std::string& input = words.word("input");
  return InputFile(is_time_series(input) ? read_time_series(input).front().files.front()
                                         : std::filesystem::path(input));
}

bool draws_grids(const OptionWords& words, const InputFile& first) {
  return is_time_series(words.word("input")) ? first.opens_as_grid() : is_grid_input(words, first);
}

bool is_grid_input(const OptionWords& words, const InputFile& input) {
  return read_options(words, true).describes_raw() || input.opens_as_grid();
}

}  // namespace v0_1
}  // namespace tessera
