// SPDX-License-Identifier: BSD-3-Clause
#include "apps/render/planned_frames.hpp"

#include <fmt/format.h>

#include <cstddef>
#include <filesystem>
#include <string>

#include "tessera/image_file.hpp"

namespace tessera::apps {
namespace {

/// Adds a suffix to a name: `a.png` and "cost" give a.cost.png.
std::filesystem::path with_suffix(const std::filesystem::path& image, const std::string& suffix) {
  std::filesystem::path name = image;
  return name.replace_extension().concat("." + suffix).concat(image.extension().string());
}

void add_outputs(FilmFrame& frame, std::size_t at, const std::vector<std::filesystem::path>& outputs) {
  for (const auto& output : outputs) frame.finished = frame.finished && std::filesystem::exists(output);
  frame.outputs.insert(frame.outputs.begin() + static_cast<std::ptrdiff_t>(at), outputs.begin(), outputs.end());
}

}  // namespace

std::vector<FilmFrame> planned_frames(const RenderOptions& options) {
  FilmPlan plan = options.plan;
  const std::size_t named = plan.outputs.size();
  if (!options.annotation.layer.empty()) plan.outputs.push_back(options.annotation.layer);
  std::vector<FilmFrame> frames = plan_film(plan);
  for (FilmFrame& frame : frames) {
    std::vector<std::filesystem::path> added;
    const int layers = options.frame.peel ? options.frame.peel->layers : 0;
    for (std::size_t i = 0; i < named; ++i)
      for (int layer = 1; layer <= layers && !is_deep_name(frame.outputs[i]); ++layer)
        added.push_back(with_suffix(frame.outputs[i], fmt::format("layer{}", layer)));
    add_outputs(frame, named, added);
    if (!options.show_balance) continue;
    added.clear();
    for (const auto& output : frame.outputs) added.push_back(with_suffix(output, "cost"));
    add_outputs(frame, frame.outputs.size(), added);
  }
  return frames;
}

std::vector<std::filesystem::path> other_outputs(const RenderOptions& options) {
  std::vector<std::filesystem::path> outputs = options.films;
  outputs.insert(outputs.end(), {options.timing, options.saved_scene});
  if (!options.report_to_standard_output) outputs.push_back(options.report);
  return outputs;
}

}  // namespace tessera::apps
