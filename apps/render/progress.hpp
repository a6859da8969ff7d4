// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <filesystem>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include "tessera/dataset.hpp"
#include "tessera/input_file.hpp"
#include "tessera/read_progress.hpp"
#include "tessera/sink.hpp"

namespace tessera::apps {

/// A line on stderr with the current stage of a run, its progress if known, and the remaining time. A separate thread
/// updates the line in place; the line is erased at the end. It appears when a stage has taken a second, which does not
/// happen in most runs. In a run of many frames it appears as soon as a frame is finished.
class StatusLine {
 public:
  /// Shows nothing unless `shown`.
  explicit StatusLine(bool shown, std::size_t frames = 1);
  ~StatusLine();
  StatusLine(const StatusLine&) = delete;
  StatusLine& operator=(const StatusLine&) = delete;

  [[nodiscard]] bool shown() const { return thread_.joinable(); }

  /// Sets the current stage, like "reading a.vtu". If it is empty, no line is shown.
  void begin(const std::string& stage);
  /// Sets the completed fraction of the stage. May be called from any thread.
  void advance(double done);
  /// Returns a callback for ReadOptions::progress, which may be used as long as this object exists; null unless the
  /// line is shown.
  [[nodiscard]] ReadProgressFunction listener();
  /// Reports that `done` frames are finished, of these `rendered` in this run; the others were skipped by --resume.
  void finish_frames(std::size_t done, std::size_t rendered);

  /// Erases the line and prevents it from appearing again while the returned lock is held, so that other lines can be
  /// printed.
  [[nodiscard]] static std::unique_lock<std::timed_mutex> away();
  /// Erases all lines permanently. For a run that exits early.
  static void end_all();

 private:
  void show_until_stopped();
  void draw(bool soon);

  std::size_t frames_, frames_done_ = 0, frames_rendered_ = 0;
  std::chrono::steady_clock::time_point run_start_, stage_start_;
  std::mutex mutex_;
  std::condition_variable stopped_;
  bool stop_ = false;
  std::string stage_;
  std::optional<ReadProgress> reading_;
  std::optional<double> done_;
  std::thread thread_;
};

/// Reports a frame's finished pixels to a status line.
class FrameProgress final : public Sink {
 public:
  FrameProgress(StatusLine& line, ImageSize size) : line_(line), pixels_(1.0 * size.width * size.height) {}
  void tile(const Tile& tile) override;

 private:
  StatusLine& line_;
  double pixels_, finished_ = 0;
};

/// Opens a file and shows the progress in `line`.
Dataset open_watched(const InputFile& file, ReadOptions options, StatusLine& line);

/// Whether a command without other progress output shows the line: if stderr is a terminal and the command is not
/// `quiet`.
bool shows_progress(bool quiet);

/// The text of the line while a file is read, after `seconds`. `progress` is empty if the progress is unknown.
std::string reading_words(const std::string& stage, const std::optional<ReadProgress>& progress, double seconds);

/// The text of the line for any other stage. `done` is empty if the progress is unknown. The text includes the
/// remaining time at the present rate as soon as this estimate is reliable.
std::string stage_words(const std::string& stage, std::optional<double> done, double seconds);

}  // namespace tessera::apps
