// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <condition_variable>
#include <cstddef>
#include <deque>
#include <exception>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

namespace tessera::apps {

/// Writes pictures on threads of its own while the next ones are made. Few wait at a time, so that memory holds no
/// film; who comes with more waits.
class PictureQueue {
 public:
  using Write = std::function<void()>;

  /// `writers` threads at most, each of which writes one picture at a time: one keeps their order, with none add()
  /// writes itself.
  explicit PictureQueue(int writers);
  /// Writes what still waits: finished pictures stay, whatever ended the run. Errors end here; finish() throws them.
  ~PictureQueue();
  PictureQueue(const PictureQueue&) = delete;
  PictureQueue& operator=(const PictureQueue&) = delete;

  /// Throws what an earlier picture threw; no other is begun after that.
  void add(Write write);
  /// Waits until all are written. Throws as add().
  void finish();

 private:
  void run();

  static constexpr std::size_t most_waiting = 1;

  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<Write> waiting_;
  int busy_ = 0;
  bool ends_ = false;
  std::exception_ptr thrown_;
  std::vector<std::thread> threads_;
};

}  // namespace tessera::apps
