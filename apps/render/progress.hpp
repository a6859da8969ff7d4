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
/// rewrites it in place; it is erased at the end. It appears once a stage has taken a second, for most runs never, and
/// in a run of many frames as soon as one is finished.
class StatusLine {
 public:
  /// Shows nothing unless `shown`.
  explicit StatusLine(bool shown, std::size_t frames = 1);
  ~StatusLine();
  StatusLine(const StatusLine&) = delete;
  StatusLine& operator=(const StatusLine&) = delete;

  [[nodiscard]] bool shown() const { return thread_.joinable(); }

  /// Sets the current stage, "reading a.vtu"; empty: not shown.
  void begin(const std::string& stage);
  /// Progress of that stage. May be called from any thread.
  void advance(double done);
  /// For ReadOptions::progress, while a file is read, as long as this object exists; null unless the line is shown.
  [[nodiscard]] ReadProgressFunction listener();
  /// `done` frames are finished, `rendered` of them in this run (--resume skips the others immediately).
  void finish_frames(std::size_t done, std::size_t rendered);

  /// Erases the line while the returned lock is held, so that other lines can be printed.
  [[nodiscard]] static std::unique_lock<std::timed_mutex> away();
  /// Erases any line permanently. For a run that exits early.
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

/// Opens a file and shows such a line.
Dataset open_watched(const InputFile& file, ReadOptions options, StatusLine& line);

/// Whether a command without other progress output shows the line: stderr is a terminal, and it is not `quiet`.
bool shows_progress(bool quiet);

/// The text of the line while a file is read, after `seconds`; without `progress` nothing more is known.
std::string reading_words(const std::string& stage, const std::optional<ReadProgress>& progress, double seconds);

/// The same for any other stage, whose progress `done` may be unknown: includes the remaining time at the present rate
/// once the estimate is reliable.
std::string stage_words(const std::string& stage, std::optional<double> done, double seconds);

}  // namespace tessera::apps
