#include "apps/frame_list.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "io/camera_file.hpp"
#include "io/mesh_reader.hpp"
#include "io/volume_reader.hpp"
#include "scene/error.hpp"

namespace tessera::apps {
namespace {

constexpr std::size_t max_frames = 10'000'000;

/// Length of the `%d` or `%0Nd` (N one or two digits) at the beginning of `text`, its width in `width`; 0 if none.
std::size_t number_pattern(std::string_view text, int& width) {
  if (text.size() < 2 || text[0] != '%') return 0;
  width = 0;
  std::size_t at = 1;
  if (text[at] == '0') {
    ++at;
    const std::size_t digits = at;
    while (at < text.size() && at < digits + 2 && text[at] >= '0' && text[at] <= '9')
      width = 10 * width + (text[at++] - '0');
    if (at == digits) return 0;
  }
  return at < text.size() && text[at] == 'd' ? at + 1 : 0;
}

std::vector<Frame> views(const RenderOptions& options) {
  std::vector<Frame> frames;
  if (options.camera_file.empty()) {
    Frame frame;
    frame.size = options.size.value_or(scene::ImageSize{});
    frames.push_back(frame);
  } else {
    for (const auto& view : io::read_cameras(options.camera_file)) {
      Frame frame;
      frame.camera = view.camera;
      frame.size = options.size.value_or(view.size.value_or(scene::ImageSize{}));
      frames.push_back(frame);
    }
  }
  if (options.orbit > 0) {
    if (frames.size() != 1)
      throw scene::bad_input(fmt::format("{}: --orbit turns one view, the file holds {}; give a file with one",
                                         options.camera_file.string(), frames.size()));
    const Frame first = frames.front();
    frames.assign(static_cast<std::size_t>(options.orbit), first);
    for (std::size_t i = 0; i < frames.size(); ++i)
      frames[i].turn = static_cast<double>(i) / static_cast<double>(frames.size());
  }
  return frames;
}

std::vector<io::TimeStep> steps(const RenderOptions& options) {
  if (options.more_inputs.empty() && io::is_time_series(options.input)) return io::read_time_series(options.input);
  std::vector<io::TimeStep> steps = {{0, {options.input}}};
  for (const auto& input : options.more_inputs) steps.push_back({static_cast<double>(steps.size()), {input}});
  for (const auto& step : steps)
    if (steps.size() > 1 && io::is_time_series(step.files.front()))
      throw scene::bad_input(fmt::format("{}: is a time series in a list of meshes; give it alone, or meshes only",
                                         step.files.front().string()));
  return steps;
}

}  // namespace

bool is_series(const RenderOptions& options) {
  return !options.more_inputs.empty() || io::is_time_series(options.input);
}

std::optional<std::string> numbered_name(const std::string& pattern, int number) {
  for (std::size_t at = 0; at < pattern.size(); ++at) {
    int width = 0;
    const std::size_t length = number_pattern(std::string_view(pattern).substr(at), width);
    if (length == 0) continue;
    return fmt::format("{}{:0{}}{}", pattern.substr(0, at), number, width, pattern.substr(at + length));
  }
  return std::nullopt;
}

std::vector<Frame> list_frames(const RenderOptions& options) {
  const auto views_of_each = views(options);
  std::vector<Frame> frames;
  const auto series = steps(options);
  if (series.size() * views_of_each.size() > max_frames)
    throw scene::bad_input(fmt::format("{}: {} time steps of {} views are more than {} frames; render them in parts",
                                       options.input.string(), series.size(), views_of_each.size(), max_frames));
  for (std::size_t step = 0; step < series.size(); ++step)
    for (Frame frame : views_of_each) {
      frame.number = static_cast<int>(frames.size());
      frame.step = step;
      frame.mesh = series[step];
      frames.push_back(std::move(frame));
    }
  for (const auto& output : options.outputs)
    for (auto& frame : frames) {
      const auto numbered = numbered_name(output.string(), frame.number);
      frame.outputs.emplace_back(numbered.value_or(output.string()));
      if (!numbered && frames.size() > 1)
        throw scene::bad_input(fmt::format("{}: {} frames need a numbered name; write {}_%04d{}", output.string(),
                                           frames.size(), (output.parent_path() / output.stem()).string(),
                                           output.extension().string()));
    }
  if (options.resume)
    for (auto& frame : frames)
      frame.finished = std::all_of(frame.outputs.begin(), frame.outputs.end(), [](const auto& output) {
        std::error_code ignored;  // unreadable folder: not finished, and the check of outputs says why
        return std::filesystem::is_regular_file(output, ignored);
      });
  // A film should not end at its last step for want of a file. The first step is looked at for all others.
  if (is_series(options))
    for (const auto& frame : frames)
      if (!frame.finished)
        for (const auto& file : frame.mesh.files)
          options.is_volume ? io::require_volume(file) : io::require_mesh_file(file);
  return frames;
}

void require_still_there(const Frame& frame) {
  if (frame.step == 0) return;
  for (const auto& file : frame.mesh.files) {
    std::error_code unreadable;  // then reading says why
    if (!std::filesystem::exists(file, unreadable) && !unreadable)
      throw scene::Error(
          scene::ErrorCode::system_failure,
          fmt::format("{}: was there when the run began and is gone; bring it back and use --resume", file.string()));
  }
}

scene::Camera view_of(const Frame& frame, const scene::Box& box, scene::ProjectionKind default_projection) {
  const auto camera =
      frame.camera ? *frame.camera : scene::frame_box(box, frame.size, default_projection, frame.turn.has_value());
  return frame.turn ? scene::orbit(camera, *frame.turn) : camera;
}

}  // namespace tessera::apps
