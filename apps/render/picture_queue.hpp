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

/// Writes images on its own threads while the next images are rendered. Only a few tasks may wait, so that memory does
/// not contain a whole film; further calls of add() block.
class PictureQueue {
 public:
  using Write = std::function<void()>;

  /// Starts at most `writers` threads, each of which writes one image at a time. A single thread writes the images in
  /// order. With zero threads, add() writes the images.
  explicit PictureQueue(int writers);
  /// Writes the remaining images, so that finished images are kept even if an error ends the run. Errors are ignored;
  /// callers that need them call finish() before.
  ~PictureQueue();
  PictureQueue(const PictureQueue&) = delete;
  PictureQueue& operator=(const PictureQueue&) = delete;

  /// Adds an image to be written. Throws the exception of an earlier image; after an exception no further image is
  /// begun.
  void add(Write write);
  /// Waits until all images are written. Throws the same errors as add().
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
