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

/// The output of a run apart from images: its line, times, verifications, progress, and the report. Only the rank that
/// prints writes output; other ranks may call the same functions.
class RunOutput {
 public:
  /// `frames` are the planned frames, `ranks` is the number of ranks of the job. The referenced objects must outlive
  /// this object; `options` may be completed later.
  RunOutput(const RenderOptions& options, const std::vector<FilmFrame>& frames, int ranks, bool prints);

  /// Sets the data's part of the run's line and of the report. Must be called before the first add().
  void describe(analysis::Description data, LoadedTransferFunction transfer_function);
  /// Prints a separate line on stderr.
  void warn(const std::string& warning);
  /// Adds a member to the report's head, for example the job's layout.
  void note(const char* name, nlohmann::ordered_json value) { report_[name] = std::move(value); }

  /// Adds a rendered and written frame. Earlier frames that were not added are reported as skipped by --resume.
  void add(const FilmFrame& frame, const FrameRecord& record);

  /// Writes the report, if requested. Returns complete, or accuracy_not_met.
  ExitCode finish();

  /// The line that shows the current stage on the rank that prints.
  [[nodiscard]] StatusLine& line() { return line_; }

  [[nodiscard]] std::size_t rendered() const { return rendered_; }
  /// Sums over the rendered frames.
  [[nodiscard]] const InDoublePrecision& in_double_precision() const { return in_double_precision_; }

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
  std::size_t done_ = 0;  ///< number of frames, rendered or skipped, that have been added in order
  std::size_t rendered_ = 0;
  InDoublePrecision in_double_precision_;
};

/// Returns `frame_ms median X min Y`, in milliseconds. The median of an even number of times is the mean of the middle
/// two.
std::string frame_ms_line(std::vector<double> times);

/// Writes JSON to a file, which appears by rename. Text that is not UTF-8 is replaced.
void write_json(const nlohmann::ordered_json& json, const std::filesystem::path& path);

/// Metadata that a trace stores about its run. `frame` is one of the frames.
TraceRun trace_run(const RenderOptions& options, std::uint64_t tets, const FilmFrame& frame, const RunOutput& output);

}  // namespace tessera::apps
