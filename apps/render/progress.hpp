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

/// A line on stderr that says what a run is at, how far that is where it is known, and how long it will take; rewritten
/// in place by a thread of its own, and gone at the end. It comes once a stage has taken a second, for most runs never,
/// and of a run of many frames as soon as one is finished.
class StatusLine {
 public:
  /// Shows nothing unless `shown`.
  explicit StatusLine(bool shown, std::size_t frames = 1);
  ~StatusLine();
  StatusLine(const StatusLine&) = delete;
  StatusLine& operator=(const StatusLine&) = delete;

  [[nodiscard]] bool shown() const { return thread_.joinable(); }

  /// What the run is at from now on, "reading a.vtu"; empty: nothing worth a line.
  void begin(const std::string& stage);
  /// Of that stage. Any thread.
  void advance(double done);
  /// While a file is read: for ReadOptions::progress, as long as this lives; null unless the line is shown.
  [[nodiscard]] ReadProgressFunction listener();
  /// `done` frames are finished, of which `rendered` in this run (--resume skips the others in no time).
  void finish_frames(std::size_t done, std::size_t rendered);

  /// Takes the line away, and keeps it away for as long as what is returned is held, so that others can be printed.
  [[nodiscard]] static std::unique_lock<std::timed_mutex> away();
  /// Takes whatever line there is away for good. For a run that ends in its midst.
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

/// Tells a line of a frame's finished pixels.
class FrameProgress final : public Sink {
 public:
  FrameProgress(StatusLine& line, ImageSize size) : line_(line), pixels_(1.0 * size.width * size.height) {}
  void tile(const Tile& tile) override;

 private:
  StatusLine& line_;
  double pixels_, finished_ = 0;
};

/// Opens a file with such a line.
Dataset open_watched(const InputFile& file, ReadOptions options, StatusLine& line);

/// Whether a command shows the line, which says nothing else: stderr is a terminal, and not to be `quiet`.
bool shows_progress(bool quiet);

/// What the line says of reading a file after `seconds`; nothing is known of how far it is without `progress`.
std::string reading_words(const std::string& stage, const std::optional<ReadProgress>& progress, double seconds);

/// The same of any other stage, of which `done` is known or not: with what is left, at its present pace, once that
/// means something.
std::string stage_words(const std::string& stage, std::optional<double> done, double seconds);

}  // namespace tessera::apps
