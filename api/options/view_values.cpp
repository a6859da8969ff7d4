// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include "api/options/choices.hpp"
#include "api/options/setting_name.hpp"
#include "api/options/values.hpp"
#include "tessera/error.hpp"

namespace tessera::api {
namespace {

ViewRequest view_request(const OptionWords& words) {
  ViewRequest request;
  if (words.given("view")) {
    const auto view = standard_view(words.word("view"));
    if (!view)
      throw bad_input(fmt::format(
          "`view`: '{}' is unknown; use front, back, left, right, top, bottom, iso or +x, -x, +y, -y, +z, -z",
          words.word("view")));
    request.view = *view;
  }
  request.up = words.vector("up");
  if (request.up == glm::dvec3(0)) throw bad_input("`up`: 0,0,0 is not a direction; give the direction that is up");
  assign(request.azimuth, words.number("azimuth"));
  assign(request.elevation, words.number("elevation"));
  assign(request.zoom, words.positive("zoom"));
  request.fit = words.given("fit");
  return request;
}

}  // namespace

void set_view(const OptionWords& words, RenderOptions& options) {
  const bool has_camera = words.given("camera");
  for (const char* option : {"view", "up", "projection"})
    if (has_camera && words.given(option))
      throw bad_input(fmt::format("{}: it has no effect with `camera`, whose file defines it; leave one of the two out",
                                  setting_name(option)));
  if (words.given("fit") && !has_camera)
    throw bad_input("`fit`: it is for a `camera` file, because other views always fit; give one, or leave `fit` out");
  options.plan.cameras = words.word("camera");
  options.plan.size = words.size("size");
  assign(options.plan.orbit, words.count("orbit", 1, 1'000'000));
  options.view = view_request(words);
  assign(options.projection, words.choice("projection", projections));
}

}  // namespace tessera::api
