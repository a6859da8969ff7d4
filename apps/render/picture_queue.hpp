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

/// Writes images on its own threads while the next ones are rendered. Only a few tasks may wait, so that memory does
/// not hold a whole film; further calls of add() block.
class PictureQueue {
 public:
  using Write = std::function<void()>;

  /// At most `writers` threads, each of which writes one image at a time: one keeps their order; with zero, add()
  /// writes itself.
  explicit PictureQueue(int writers);
  /// Writes the remaining images: finished images are kept, whatever ended the run. Errors are dropped; finish() throws
  /// them.
  ~PictureQueue();
  PictureQueue(const PictureQueue&) = delete;
  PictureQueue& operator=(const PictureQueue&) = delete;

  /// Throws the exception of an earlier image, after which no other is begun.
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
