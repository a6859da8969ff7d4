#include "apps/frame_list.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "io/camera_file.hpp"
#include "scene/error.hpp"

namespace tessera::apps {
namespace {

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
  for (std::size_t i = 0; i < frames.size(); ++i) frames[i].number = static_cast<int>(i);
  return frames;
}

}  // namespace

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
  auto frames = views(options);
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
  return frames;
}

scene::Camera view_of(const Frame& frame, const scene::Box& box, scene::ProjectionKind default_projection) {
  const auto camera =
      frame.camera ? *frame.camera : scene::frame_box(box, frame.size, default_projection, frame.turn.has_value());
  return frame.turn ? scene::orbit(camera, *frame.turn) : camera;
}

}  // namespace tessera::apps
