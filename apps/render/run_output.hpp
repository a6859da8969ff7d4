// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <nlohmann/json.hpp>
#include <span>
#include <vector>

#include "apps/exit_code.hpp"
#include "apps/render/frame_reports.hpp"
#include "apps/render/progress.hpp"
#include "apps/render/report.hpp"
#include "tessera/program/film.hpp"
#include "tessera/trace_file.hpp"

namespace tessera::apps {

/// The output of a run besides images: its line, times, verifications, progress, and the report. Only the rank that
/// prints writes any of it; other ranks may call the same functions.
class RunOutput {
 public:
  /// Of the planned `frames`; `ranks` of the job. References outlive it; `options` may be completed meanwhile.
  RunOutput(const RenderOptions& options, const std::vector<FilmFrame>& frames, int ranks, bool prints);

  /// What the run line and the report state of the data; before the first add().
  void describe(analysis::Description data, LoadedTransferFunction transfer_function);
  /// A line of its own on stderr.
  void warn(const std::string& warning);
  /// More for the report's head, like the job's shape.
  void note(const char* name, nlohmann::ordered_json value) { report_[name] = std::move(value); }

  /// A frame that was rendered and written; those before it that were not rendered are ones that --resume leaves alone.
  void add(const FilmFrame& frame, const FrameRecord& record);

  /// Writes the report, if asked. Complete, or accuracy_not_met.
  ExitCode finish();

  /// The line that shows the current stage, on the rank that prints.
  [[nodiscard]] StatusLine& line() { return line_; }

  [[nodiscard]] std::size_t rendered() const { return rendered_; }

 private:
  void skip_to(std::size_t frame);

  const RenderOptions& options_;
  const std::vector<FilmFrame>& frames_;
  const bool prints_;
  StatusLine line_;
  std::optional<analysis::Description> data_;
  std::optional<LoadedTransferFunction> transfer_function_;
  nlohmann::ordered_json report_;
  FrameReports frame_reports_;
  bool met_ = true;
  std::size_t done_ = 0;  ///< frames in their order, rendered or skipped
  std::size_t rendered_ = 0;
};

/// `frame_ms median X min Y`, milliseconds. The median of an even number is the mean of the middle two.
std::string frame_ms_line(std::vector<double> times);

/// Appears by rename. Text that is not UTF-8 is replaced.
void write_json(const nlohmann::ordered_json& json, const std::filesystem::path& path);

/// Metadata that a trace stores about its run.
TraceRun trace_run(const RenderOptions& options, std::uint64_t tets, const FilmFrame& frame, std::size_t rendered);

}  // namespace tessera::apps
