// SPDX-License-Identifier: BSD-3-Clause
#include "apps/options/view_options.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>

#include "apps/options/argument_values.hpp"
#include "tessera/error.hpp"

namespace tessera::apps {

void add_view_options(CLI::App& command, ViewWords& words) {
  command
      .add_option("--view", words.view,
                  "direction: front looks along +y, of a patient at the face; +x looks along +x (default: what stands, "
                  "stands; a little from "
                  "the right and above)")
      ->type_name("front|back|left|right|top|bottom|iso|+x|-x|+y|-y|+z|-z");
  command.add_option("--up", words.up, "world direction that points up (default: z; y in views along z)")
      ->type_name("X,Y,Z");
  command.add_option("--azimuth", words.azimuth, "turns the eye round the up axis, to the right")->type_name("DEGREES");
  command.add_option("--elevation", words.elevation, "turns the eye upwards, after --azimuth")->type_name("DEGREES");
  command.add_option("--zoom", words.zoom, "enlarges the middle of the picture so many times")->type_name("FACTOR");
  command.add_flag("--fit", words.fit, "with --camera: the file's direction, framed on the data anew");
}

ViewRequest view_request(const ViewWords& words, bool has_camera_file) {
  ViewRequest request;
  for (const auto& [option, word] : {std::pair{"--view", &words.view}, std::pair{"--up", &words.up}})
    if (has_camera_file && !word->empty())
      throw bad_input(
          fmt::format("{}: has no effect with --camera, whose file says it; leave one of the two out", option));
  if (!words.view.empty()) {
    const auto view = standard_view(words.view);
    if (!view)
      throw bad_input(fmt::format(
          "--view: '{}' is unknown; use front, back, left, right, top, bottom, iso or +x, -x, +y, -y, +z, -z",
          words.view));
    request.view = *view;
  }
  if (!words.up.empty()) request.up = parse_vector("--up", words.up, false);
  if (request.up && *request.up == glm::dvec3(0)) throw bad_input("--up: 0,0,0 is no direction; say which way is up");
  if (!words.azimuth.empty()) request.azimuth = parse_number("--azimuth", words.azimuth);
  if (!words.elevation.empty()) request.elevation = parse_number("--elevation", words.elevation);
  if (!words.zoom.empty()) request.zoom = parse_positive("--zoom", words.zoom);
  if (words.fit && !has_camera_file)
    throw bad_input("--fit: is for a --camera file, other views fit anyway; name one, or leave it out");
  request.fit = words.fit;
  return request;
}

}  // namespace tessera::apps
