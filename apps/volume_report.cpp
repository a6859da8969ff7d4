#include "apps/volume_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <numeric>

#include "apps/report.hpp"
#include "apps/setting_words.hpp"
#include "apps/volume_input.hpp"

namespace tessera::apps {
namespace {

using Json = nlohmann::ordered_json;

bool takes_steps(volume::Method method) {
  return method == volume::Method::sampled || method == volume::Method::preintegrated;
}

std::string method_words(const volume::RenderSettings& settings) {
  std::string words = method_word(settings.method);
  if (settings.method == volume::Method::automatic) words += fmt::format(" to {:g}", settings.accuracy);
  if (takes_steps(settings.method)) words += fmt::format(" every {:g} voxels", settings.step);
  if (settings.shading) words += ", shaded";
  return words;
}

std::string ms_words(double ms) { return ms < 100 ? fmt::format("{:.3g} ms", ms) : fmt::format("{:.0f} ms", ms); }

/// How the work was shared, if it was.
std::string balance_words(const RenderOptions& options, const VolumeFrameRecord& record) {
  if (record.samples.size() < 2) return {};
  const std::vector<double> samples(record.samples.begin(), record.samples.end());
  return fmt::format(", {} processes by {}: samples uneven by {:.1f} %", samples.size(),
                     balance_word(options.balance.balance), 100 * deviation(samples));
}

Json balance_json(const RenderOptions& options, const VolumeFrameRecord& record) {
  Json processes = Json::array();
  for (std::size_t rank = 0; rank < record.samples.size(); ++rank) {
    const volume::PixelRegion r = record.split.region(static_cast<int>(rank));
    processes.push_back({{"rectangle", {r.x0, r.y0, r.x1, r.y1}},
                         {"samples", record.samples[rank]},
                         {"cpu_ms", 1e3 * record.cpu_seconds[rank]}});
  }
  return {{"method", balance_word(options.balance.balance)},
          {"samples_deviation", deviation({record.samples.begin(), record.samples.end()})},
          {"cpu_deviation", deviation(record.cpu_seconds)},
          {"processes", processes}};
}

}  // namespace

double deviation(const std::vector<double>& work) {
  const double sum = std::accumulate(work.begin(), work.end(), 0.0);
  if (!(sum > 0)) return 0;
  const auto [least, most] = std::minmax_element(work.begin(), work.end());
  return (*most - *least) * static_cast<double>(work.size()) / sum;
}

const char* balance_word(frame::Balance balance) {
  constexpr std::array words = {"accurate", "backface", "splatting", "previous", "even"};
  return words[static_cast<std::size_t>(balance)];
}

const char* method_word(volume::Method method) {
  constexpr std::array words = {"auto", "exact", "sampled", "preintegrated"};
  return words[static_cast<std::size_t>(method)];
}

Json volume_method_json(const RenderOptions& options, int ranks) {
  const volume::RenderSettings& s = options.volume_settings;
  Json json = {{"integrator", method_word(s.method)}};
  if (s.method == volume::Method::automatic) json["accuracy"] = s.accuracy;
  if (takes_steps(s.method)) json["step"] = s.step;
  json["emission"] = s.emission == scene::Emission::absorption ? "absorption" : "independent";
  json["shade"] = s.shading.has_value();
  if (s.shading)
    json["light"] = {{"frame", s.shading->camera_light ? "camera" : "world"},
                     {"direction", {s.shading->to_light.x, s.shading->to_light.y, s.shading->to_light.z}}};
  json["backend"] = "cpu";
  if (!options.without.empty()) json["without"] = options.without;
  json["blend"] = options.display_blend ? "display" : "linear";
  json["threads"] = s.threads;
  json["brick_size"] = s.brick_size;
  json["cache"] = s.cache == volume::CachePolicy::lru ? "lru" : "proximity";
  json["preload"] = s.preload_limit;
  json["memory_bytes"] = s.memory_bytes;
  json["ranks"] = ranks;
  json["balance"] = {{"method", balance_word(options.balance.balance)},
                     {"resolution", options.balance.resolution},
                     {"weights", options.balance.weights}};
  return json;
}

Json volume_frame_json(const RenderOptions& options, const Frame& frame, const VolumeFrameRecord* record) {
  Json json = frame_json(frame, nullptr);
  json["skipped"] = record == nullptr;
  if (record == nullptr) return json;
  const volume::RenderStatistics& s = record->statistics;
  json["view"] = view_json(record->camera, frame.size);
  json["frame_ms"] = record->frame_ms;
  json["counters"] = {{"rays", s.rays},
                      {"voxels_visited", s.voxels_visited},
                      {"samples", s.samples},
                      {"pixels_in_double_precision", s.pixels_again},
                      {"bricks_total", s.bricks_total},
                      {"bricks_invisible", s.bricks_invisible},
                      {"brick_hits", s.brick_hits},
                      {"bricks_loaded", s.bricks_loaded},
                      {"bricks_evicted", s.bricks_evicted},
                      {"bytes_loaded", s.bytes_loaded},
                      {"bytes_resident", s.bytes_resident},
                      {"peak_bytes", s.peak_bytes},
                      {"blank_samples", s.blank_samples}};
  if (record->deep_samples > 0) json["counters"]["deep_samples"] = record->deep_samples;
  json["instruction_set"] = s.instruction_set;
  json["balance"] = balance_json(options, *record);
  if (record->verification) json["verify"] = verification_json(*record->verification);
  return json;
}

std::string volume_run_line(const RenderOptions& options, const io::VolumeFile& file,
                            const colormaps::LoadedTransferFunction& loaded, const std::vector<Frame>& frames,
                            const Frame& first, const VolumeFrameRecord& record) {
  const volume::RenderStatistics& s = record.statistics;
  std::string line = fmt::format("{}: {}; field {} ({}) {:.6g} to {:.6g}; {}; view {}, {}x{}",
                                 first.mesh.files.front().string(), samples_line(file), file.source->grid().field_name,
                                 file.source->geometry().association == scene::Association::point ? "point" : "cell",
                                 file.range.low, file.range.high, transfer_function_line(loaded),
                                 view_line(record.camera), first.size.width, first.size.height);
  if (frames.size() > 1) line += fmt::format(" (frame {} of {})", first.number + 1, frames.size());
  line +=
      fmt::format("; {} of {} bricks invisible, {} loaded; {} voxels visited; {}, {}, {:.3g} ms{}", s.bricks_invisible,
                  s.bricks_total, s.bricks_loaded, s.voxels_visited, method_words(options.volume_settings),
                  s.instruction_set, record.frame_ms.front(), balance_words(options, record));
  if (const std::size_t steps = frames.back().step + 1; is_series(options))
    line += fmt::format("; transfer function{} of the first of {} time steps, {}, for all",
                        first.camera ? "" : " and view", steps, frames.front().mesh.files.front().string());
  for (const auto& note : with_options(file.notes)) line += fmt::format("; {}", note);
  return line;
}

std::string volume_frame_line(const RenderOptions& options, const std::vector<Frame>& frames, const Frame& frame,
                              const VolumeFrameRecord& record) {
  std::string line = fmt::format("frame {} of {}: ", frame.number + 1, frames.size());
  if (is_series(options)) line += frame.mesh.files.front().filename().string() + ", ";
  return line + fmt::format("{} voxels visited, {}{}", record.statistics.voxels_visited,
                            ms_words(record.frame_ms.front()), balance_words(options, record));
}

}  // namespace tessera::apps
