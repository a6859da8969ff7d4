#pragma once

#include <nlohmann/json.hpp>
#include <vector>

#include "apps/frame_list.hpp"
#include "apps/frame_reports.hpp"
#include "apps/progress.hpp"
#include "apps/report.hpp"
#include "io/chrome_trace.hpp"

namespace tessera::apps {

/// What a run says while it goes on and at its end: its line, times, verifications, progress, and the report. Used by
/// the one process or rank that speaks.
class RunOutput {
 public:
  /// `options` for what is shown; `ranks` of the job.
  RunOutput(const RenderOptions& options, const std::vector<Frame>& frames, int ranks);

  /// What the run line and the report say of the data; before the first add().
  void describe(Description data, LoadedTransferFunction transfer_function);
  /// More for the report's head, like the job's shape.
  void note(const char* name, nlohmann::ordered_json value) { report_[name] = std::move(value); }

  /// A frame that --resume left alone.
  void skip(const RenderOptions& options, const Frame& frame);
  /// A frame that was rendered and written.
  void add(const RenderOptions& options, const Frame& frame, const FrameRecord& record);

  /// Writes the report, if asked. Complete, or accuracy_not_met.
  scene::ExitCode finish(const RenderOptions& options);

  [[nodiscard]] std::size_t rendered() const { return rendered_; }

 private:
  const std::vector<Frame>& frames_;
  Progress progress_;
  std::optional<Description> data_;
  std::optional<LoadedTransferFunction> transfer_function_;
  nlohmann::ordered_json report_;
  FrameReports frame_reports_;
  bool met_ = true;
  std::size_t done_ = 0, rendered_ = 0;
};

/// Writes a frame's pictures, deep ones from `deep`. Throws scene::Error(system_failure) if that cannot be done any
/// more, as check_outputs() found it could.
void write_pictures(const scene::Image& image, const scene::DeepImage& deep, const Frame& frame,
                    const RenderOptions& options);

/// `frame_ms median X min Y`, milliseconds. The median of an even number is the mean of the middle two.
std::string frame_ms_line(std::vector<double> times);

/// Appears by rename. Text that is not UTF-8 is replaced.
void write_json(const nlohmann::ordered_json& json, const std::filesystem::path& path);

/// What a trace says of the run it is of.
io::TraceRun trace_run(const RenderOptions& options, std::uint64_t tets, const Frame& frame, std::size_t rendered);

}  // namespace tessera::apps
