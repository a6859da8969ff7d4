#pragma once

#include <chrono>
#include <cstddef>

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

}  // namespace tessera::apps
