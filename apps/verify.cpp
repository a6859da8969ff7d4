#include "apps/verify.hpp"

#include <fmt/format.h>

namespace tessera::apps {
namespace {

using Json = nlohmann::ordered_json;
using reference::Suspicion;

const char* reason(const std::optional<Suspicion>& why) { return why ? reference::name_of(*why) : "random"; }

Json tally_json(const reference::Tally& tally) {
  return {{"pixels", tally.pixels},
          {"max_error", tally.max_error},
          {"over_bound", tally.over_bound},
          {"excused", tally.excused}};
}

}  // namespace

std::string verification_line(const reference::Verification& verification, int frame_number) {
  const auto& judgement = verification.judgement;
  const auto verdict = verification.bound
                           ? fmt::format("bound {:.3g} {}", *verification.bound, verification.met() ? "met" : "NOT met")
                           : std::string("no bound promised");
  std::string line = fmt::format("verify frame {}: {} pixels, max {:.3g} rms {:.3g}, worst at ({}, {}), {} excused; {}",
                                 frame_number, judgement.pixels_checked, judgement.max_error, judgement.rms_error,
                                 judgement.worst_x, judgement.worst_y, judgement.excused, verdict);
  line += fmt::format("; worst: {}; chosen: {} random", reason(verification.worst), verification.random.pixels);
  for (std::size_t kind = 0; kind < reference::suspicions; ++kind)
    if (const std::size_t pixels = verification.chosen[kind].pixels; pixels > 0)
      line += fmt::format(", {} {}", pixels, reference::name_of(static_cast<Suspicion>(kind)));
  return line;
}

Json verification_json(const reference::Verification& verification) {
  const auto& judgement = verification.judgement;
  Json json = {{"pixels", judgement.pixels_checked},
               {"max_error", judgement.max_error},
               {"rms_error", judgement.rms_error},
               {"max_error_not_excused", judgement.max_error_not_excused},
               {"worst_pixel", {judgement.worst_x, judgement.worst_y}},
               {"worst_value", judgement.worst_value},
               {"worst_reference", judgement.worst_reference},
               {"worst_chosen", reason(verification.worst)},
               {"over_bound", judgement.over_bound},
               {"excused", judgement.excused},
               {"met", verification.met()},
               {"random", tally_json(verification.random)}};
  Json chosen = Json::object();
  for (std::size_t kind = 0; kind < reference::suspicions; ++kind)
    if (verification.chosen[kind].pixels > 0)
      chosen[reference::name_of(static_cast<Suspicion>(kind))] = tally_json(verification.chosen[kind]);
  json["chosen"] = std::move(chosen);
  if (verification.bound) json["bound"] = *verification.bound;
  return json;
}

}  // namespace tessera::apps
