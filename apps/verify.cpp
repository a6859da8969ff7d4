#include "apps/verify.hpp"

#include <fmt/format.h>

#include <span>

namespace tessera::apps {
namespace {

using Json = nlohmann::ordered_json;

Json tally_json(const Verification::Tally& tally) {
  return {{"pixels", tally.pixels},
          {"max_error", tally.max_error},
          {"over_bound", tally.over_bound},
          {"excused", tally.excused}};
}

}  // namespace

std::string verification_line(const Verification& v, int frame_number) {
  const auto verdict =
      v.bound ? fmt::format("bound {:.3g} {}", *v.bound, v.met ? "met" : "NOT met") : std::string("no bound promised");
  std::string line =
      fmt::format("verify frame {}: {} pixels, max {:.3g} rms {:.3g}, worst at ({}, {}), {} excused; {}", frame_number,
                  v.pixels_checked, v.max_error, v.rms_error, v.worst_x, v.worst_y, v.excused, verdict);
  line += fmt::format("; worst: {}; chosen: {} random", v.worst_reason, v.tallies.front().pixels);
  for (const Verification::Tally& tally : std::span(v.tallies).subspan(1))
    line += fmt::format(", {} {}", tally.pixels, tally.reason);
  return line;
}

Json verification_json(const Verification& v) {
  Json json = {{"pixels", v.pixels_checked},
               {"max_error", v.max_error},
               {"rms_error", v.rms_error},
               {"max_error_not_excused", v.max_error_not_excused},
               {"worst_pixel", {v.worst_x, v.worst_y}},
               {"worst_value", v.worst_value},
               {"worst_reference", v.worst_reference},
               {"worst_chosen", v.worst_reason},
               {"over_bound", v.over_bound},
               {"excused", v.excused},
               {"met", v.met},
               {"random", tally_json(v.tallies.front())}};
  Json chosen = Json::object();
  for (const Verification::Tally& tally : std::span(v.tallies).subspan(1)) chosen[tally.reason] = tally_json(tally);
  json["chosen"] = std::move(chosen);
  if (v.bound) json["bound"] = *v.bound;
  return json;
}

}  // namespace tessera::apps
