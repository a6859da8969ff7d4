// SPDX-License-Identifier: BSD-3-Clause
#include "io/scene/camera_file.hpp"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "io/scene/camera_words.hpp"
#include "io/text/json_text.hpp"
#include "io/text/scanner.hpp"
#include "io/text/text_file.hpp"
#include "scene/error.hpp"
#include "system/atomic_file.hpp"

namespace tessera::io {
namespace {

using nlohmann::json;

CameraFile view_from_json(const json& object, const std::string& place) {
  if (!object.is_object())
    throw scene::bad_input(place + ": is not an object; a view is {\"position\": [x, y, z], \"focal_point\": ...}");
  CameraWords words(place);
  for (const auto& item : object.items()) {
    const std::string& key = item.key();  // no structured binding: a lambda may not capture one
    const json& value = item.value();
    std::vector<double> numbers;
    const auto take = [&](const json& number) {
      if (!number.is_number() || !std::isfinite(number.get<double>()))
        throw scene::bad_input(
            fmt::format("{}: {} holds something that is not a finite number; give numbers only", place, quote(key)));
      numbers.push_back(number.get<double>());
    };
    if (value.is_array()) {
      // Stops when there are more numbers than any word takes, so that a long list is refused without copying it.
      for (const json& number : value) {
        take(number);
        if (numbers.size() > 8) break;
      }
    } else {
      take(value);
    }
    words.set(key, numbers, place);
  }
  return words.finish();
}

}  // namespace

std::vector<CameraFile> parse_json_cameras(std::string_view text, const std::string& source) {
  const json root = parse_json(text, source);
  if (!root.is_array()) return {view_from_json(root, source)};
  if (root.empty()) throw scene::bad_input(source + ": is an empty list; give at least one view");
  std::vector<CameraFile> views;
  for (const json& object : root)
    views.push_back(view_from_json(object, fmt::format("{}: view {}", source, views.size() + 1)));
  return views;
}

CameraFile parse_text_camera(std::string_view text, const std::string& source) {
  CameraWords words(source);
  TextScanner lines(text, source, ascii_blanks, '#');
  std::vector<double> numbers;
  while (lines.next_line()) {
    const std::vector<std::string_view> found = split_words(lines.line());
    const std::string at = fmt::format("{}: line {}", source, lines.line_number());
    numbers.clear();
    for (std::size_t i = 1; i < found.size(); ++i) {
      const auto number = parse_number(found[i]);
      if (!number)
        throw scene::bad_input(
            fmt::format("{}: {} is not a finite number; each line is a word and its numbers", at, quote(found[i])));
      numbers.push_back(*number);
    }
    words.set(found[0], numbers, at);
  }
  return words.finish();
}

std::vector<CameraFile> parse_cameras(std::string_view text, const std::string& source) {
  switch (first_character(text)) {
    case '\0':
      throw scene::bad_input(source + ": is empty; give position, focal_point and parallel_scale or view_angle");
    case '{':
    case '[':
      return parse_json_cameras(text, source);
    case '<':
      return {parse_pvcc_camera(text, source)};
    default:
      return {parse_text_camera(text, source)};
  }
}

std::vector<CameraFile> read_cameras(const std::filesystem::path& file) {
  const std::string source = file.string();
  try {
    return parse_cameras(read_text_file(file), source);
  } catch (const scene::Error& error) {
    throw scene::with_subject(error, source);
  }
}

std::string camera_json(const CameraFile& view) {
  const auto vector = [](const glm::dvec3& v) { return json::array({v.x, v.y, v.z}); };
  const scene::Camera& camera = view.camera;
  nlohmann::ordered_json out{{"position", vector(camera.position)},
                             {"focal_point", vector(camera.focal_point)},
                             {"view_up", vector(camera.view_up)}};
  if (camera.projection == scene::ProjectionKind::orthographic)
    out["parallel_scale"] = camera.parallel_scale;
  else
    out["view_angle"] = camera.view_angle;
  if (camera.clipping_range)
    out["clipping_range"] = json::array({camera.clipping_range->near_distance, camera.clipping_range->far_distance});
  if (view.size) out["size"] = json::array({view.size->width, view.size->height});
  // Each line contains one word and its numbers.
  std::string text = "{";
  for (const auto& [key, value] : out.items())
    text += fmt::format("{}\n  \"{}\": {}", text.size() > 1 ? "," : "", key, value.dump());
  return text + "\n}\n";
}

void write_camera(const CameraFile& camera, const std::filesystem::path& file) {
  system::AtomicFile output(file);
  output.write(camera_json(camera));
  output.commit();
}

}  // namespace tessera::io
