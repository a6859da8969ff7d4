// SPDX-License-Identifier: BSD-3-Clause
#include "apps/options/setting_words.hpp"

#include <algorithm>
#include <array>
#include <iterator>

namespace tessera::apps {
namespace {

// Written down, and not asked of CLI11, for an error may come before the options are declared and on any thread. A test
// compares it with what --help says.
constexpr std::string_view setting_names =
    "accuracy all allow_host annotate annotation_color annotation_layer annotation_size axes azimuth "
    "backend background balance balance_resolution balance_weights bind blend block brick_size "
    "budget_seconds cache camera check clip color_bar color_bar_range color_bar_scale color_bar_title "
    "compositor compositors config csv deep_accuracy dims direct_send distribution drop_duplicates edge_bricks "
    "egl_device "
    "elevation emission endian exchange field field_unit figure fit frame_rate framebuffer frames_in_flight "
    "half help help_all higher_order_tets higher_order_tolerance integrator iso json labels latency length_unit "
    "light like log max_volume memory no_shade on_stall opacity opacity_points opacity_scale orbit origin "
    "outline output partition peel peer pieces pixels png_bits port preload preset progress projection "
    "projectors q quiet range rasterizer repeat report rescale resume save_config scale scale_bar seed shade show "
    "size skip smooth spacing stall_timeout step subdivide surface threads threshold tile_size time_step "
    "timing tls_certificate tls_key transfer_function type unit_distance up verify version view warp without "
    "zoom";

constexpr auto settings = [] {
  std::array<std::string_view, std::ranges::count(setting_names, ' ') + 1> words;
  std::string_view rest = setting_names;
  for (std::string_view& word : words) {
    word = rest.substr(0, rest.find(' '));
    rest.remove_prefix(std::min(word.size() + 1, rest.size()));
  }
  return words;
}();
static_assert(std::ranges::is_sorted(settings));

/// A setting's name is a word of the sentence: not a part of a file's name, nor quoted.
bool may_precede(std::string_view before) { return before.empty() || before.back() == ' ' || before.back() == '('; }
bool may_follow(std::string_view after) {
  return after.empty() || std::string_view(" ,;:)").find(after.front()) != std::string_view::npos;
}

}  // namespace

std::span<const std::string_view> option_settings() { return settings; }

std::string with_options(std::string_view text) {
  std::string result;
  std::size_t done = 0;
  while (true) {
    const std::size_t open = text.find('`', done);
    const std::size_t close = open == std::string_view::npos ? open : text.find('`', open + 1);
    if (close == std::string_view::npos) break;
    const std::string_view name = text.substr(open + 1, close - open - 1);
    if (!may_precede(text.substr(0, open)) || !may_follow(text.substr(close + 1)) ||
        !std::ranges::binary_search(settings, name)) {
      // The second backquote may be the first of a name.
      result += text.substr(done, close - done);
      done = close;
      continue;
    }
    result += text.substr(done, open - done);
    result += "--";
    std::ranges::replace_copy(name, std::back_inserter(result), '_', '-');
    done = close + 1;
  }
  return result += text.substr(done);
}

std::vector<std::string> with_options(const std::vector<std::string>& notes) {
  std::vector<std::string> worded;
  worded.reserve(notes.size());
  for (const std::string& note : notes) worded.push_back(with_options(note));
  return worded;
}

}  // namespace tessera::apps
