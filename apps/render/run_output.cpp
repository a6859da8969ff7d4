// SPDX-License-Identifier: BSD-3-Clause
#include "apps/render/run_output.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "apps/standard_streams.hpp"
#include "apps/stderr_lines.hpp"
#include "tessera/program/output_file.hpp"
#include "tessera/version.hpp"

namespace tessera::apps {
namespace {

using Json = nlohmann::ordered_json;

}  // namespace

std::string frame_ms_line(std::vector<double> times) {
  std::sort(times.begin(), times.end());
  const std::size_t middle = times.size() / 2;
  const double median = times.size() % 2 == 1 ? times[middle] : (times[middle - 1] + times[middle]) / 2;
  return fmt::format("frame_ms median {:.3f} min {:.3f}", median, times.front());
}

void write_json(const Json& json, const std::filesystem::path& path) {
  // Text that is not UTF-8, such as a file name, is replaced, since JSON must be UTF-8.
  write_text(path, json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n");
}

RunOutput::RunOutput(const RenderOptions& options, const std::vector<FilmFrame>& frames, int ranks, bool prints)
    : options_(options),
      frames_(frames),
      prints_(prints),
      line_(options.progress && prints, frames.size()),
      report_(analysis::program_json()),
      frame_reports_(!options.report.empty()) {
  report_["method"] = method_json(options, ranks);
}

void RunOutput::describe(analysis::Description data, LoadedTransferFunction transfer_function) {
  std::vector<std::string> warnings = data.warnings;
  warnings.insert(warnings.end(), transfer_function.warnings.begin(), transfer_function.warnings.end());
  for (const std::string& warning : warnings) warn(warning);
  data_ = std::move(data);
  transfer_function_ = std::move(transfer_function);
}

void RunOutput::warn(const std::string& warning) {
  if (!prints_) return;
  const auto away = StatusLine::away();
  print_lines(fmt::format("tessera: warning: {}: {}", options_.input().string(), warning));
}

void RunOutput::skip_to(std::size_t frame) {
  while (done_ < frame) {
    if (frame_reports_.kept()) frame_reports_.add(frame_json(options_, frames_[done_], nullptr));
    line_.finish_frames(++done_, rendered_);
  }
}

void RunOutput::add(const FilmFrame& frame, const FrameRecord& record) {
  if (!prints_) return;
  skip_to(static_cast<std::size_t>(&frame - frames_.data()));
  if (frame_reports_.kept()) frame_reports_.add(frame_json(options_, frame, &record));
  {
    const auto away = StatusLine::away();
    if (rendered_ == 0 && !options_.quiet) {
      print_lines(run_line(options_, *data_, *transfer_function_, frames_, frame, record));
      for (const std::string& note : data_->notes) print_lines("note: " + note);
    }
    if (frames_.size() > 1 && !options_.quiet) {
      print_lines(frame_line(options_, frames_, frame, record));
    }
    // If standard output is an image or the report, it contains nothing else.
    std::FILE* const lines = options_.to_standard_output || options_.report_to_standard_output ? stderr : stdout;
    if (options_.repeat > 0) fmt::print(lines, "{}\n", frame_ms_line(record.frame_ms));
    if (record.verification) {
      fmt::print(lines, "{}\n", verification_line(*record.verification, frame.number));
      met_ = met_ && record.verification->met;
    }
  }
  const auto [parts, all] = apps::in_double_precision(record.statistics, options_.is_grid());
  in_double_precision_.parts += parts, in_double_precision_.all += all;
  line_.finish_frames(++done_, ++rendered_);
}

ExitCode RunOutput::finish() {
  if (!prints_) return ExitCode::complete;
  skip_to(frames_.size());
  line_.begin("");
  const auto away = StatusLine::away();
  if (data_) {
    report_[data_->is_mesh ? "mesh" : "volume"] = analysis::data_json(options_.input(), *data_);
    report_["transfer_function"] = analysis::transfer_function_json(*transfer_function_);
    if (options_.function.logarithmic) report_["transfer_function"]["scale"] = "log";  // also read by --like
  } else if (!options_.quiet) {
    print_lines(fmt::format("{}: all {} frames exist already, so nothing was rendered", options_.input().string(),
                            frames_.size()));
  }
  if (options_.report_to_standard_output)
    write_standard_output(with_stream_names(frame_reports_.text(report_)));
  else if (!options_.report.empty())
    write_text(options_.report, with_stream_names(frame_reports_.text(report_)));
  if (!options_.saved_scene.empty()) write_text(options_.saved_scene, options_.scene);
  return met_ ? ExitCode::complete : ExitCode::accuracy_not_met;
}

TraceRun trace_run(const RenderOptions& options, std::uint64_t tets, const FilmFrame& frame, const RunOutput& output) {
  const Json method = method_json(options, 1);
  TraceRun traced;
  traced.version = version();
  traced.commit = commit();
  traced.build = build_facts();
  traced.input = options.input().string();
  traced.tets = tets;
  traced.frames = static_cast<int>(output.rendered()) * std::max(options.repeat, 1);
  traced.parts = output.in_double_precision().all;
  traced.parts_in_double_precision = output.in_double_precision().parts;
  traced.width = frame.size.width;
  traced.height = frame.size.height;
  traced.threads = threads_for(options.settings.threads);
  traced.rasterizer = method.value("rasterizer", "");
  traced.integrator = method.at("integrator");
  return traced;
}

}  // namespace tessera::apps
