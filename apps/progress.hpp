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
#include "tessera/read_progress.hpp"

namespace tessera::apps {

/// A line on stderr that says how far a run of many frames is, rewritten in place and gone at the end.
class Progress {
 public:
  /// Shows nothing unless `shown`, nor for a single frame.
  Progress(bool shown, std::size_t frames);
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  /// `done` frames are finished, of which `rendered` in this run (--resume skips the others in no time).
  void update(std::size_t done, std::size_t rendered);
  /// Takes the line away, so that another can be printed.
  void clear();

 private:
  bool shown_;
  std::size_t frames_;
  std::chrono::steady_clock::time_point start_;
};

/// A line on stderr that says that a file is being read, since when, and how far that is where it is known. It comes
/// after a second, for most files never, is rewritten in place by a thread of its own, and is gone at the end.
class ReadingLine {
 public:
  /// Shows nothing unless `shown`.
  ReadingLine(bool shown, const std::filesystem::path& file);
  ~ReadingLine();
  ReadingLine(const ReadingLine&) = delete;
  ReadingLine& operator=(const ReadingLine&) = delete;

  /// For ReadOptions::progress, while this lives; null unless it is shown.
  [[nodiscard]] ReadProgressFunction listener();

 private:
  void show_until_stopped();

  std::string file_;
  std::chrono::steady_clock::time_point start_;
  std::mutex mutex_;
  std::condition_variable stopped_;
  bool stop_ = false;
  std::optional<ReadProgress> progress_;
  std::thread thread_;
};

/// Opens a file with such a line, if stderr is a terminal and not to be `quiet`.
Dataset open_watched(const std::filesystem::path& file, ReadOptions options, bool quiet);

/// What the line says after `seconds`; nothing is known of how far it is without `progress`.
std::string reading_words(const std::string& file, const std::optional<ReadProgress>& progress, double seconds);

}  // namespace tessera::apps
