// SPDX-License-Identifier: BSD-3-Clause
#include "apps/render/picture_queue.hpp"

#include <iterator>
#include <system_error>
#include <utility>

namespace tessera::apps {

PictureQueue::PictureQueue(int writers) {
  try {
    while (std::ssize(threads_) < writers) threads_.emplace_back([this] { run(); });
  } catch (const std::system_error&) {  // if a thread cannot be started, the others do the work
  }
}

PictureQueue::~PictureQueue() {
  {
    const std::lock_guard lock(mutex_);
    ends_ = true;
  }
  changed_.notify_all();
  for (std::thread& thread : threads_) thread.join();
}

void PictureQueue::add(Write write) {
  if (threads_.empty()) return write();
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [this] { return thrown_ || waiting_.size() < most_waiting; });
  if (thrown_) std::rethrow_exception(thrown_);
  waiting_.push_back(std::move(write));
  changed_.notify_all();
}

void PictureQueue::finish() {
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [this] { return busy_ == 0 && (thrown_ || waiting_.empty()); });
  if (thrown_) std::rethrow_exception(thrown_);
}

void PictureQueue::run() {
  std::unique_lock lock(mutex_);
  while (true) {
    changed_.wait(lock, [this] { return ends_ || !waiting_.empty(); });
    if (waiting_.empty()) return;
    ++busy_;
    {
      const Write write = std::move(waiting_.front());  // its image is released before the next task is accepted
      waiting_.pop_front();
      changed_.notify_all();
      lock.unlock();
      std::exception_ptr thrown;
      try {
        write();
      } catch (...) {
        thrown = std::current_exception();
      }
      lock.lock();
      if (thrown) {
        if (!thrown_) thrown_ = thrown;
        waiting_.clear();
      }
    }
    --busy_;
    changed_.notify_all();
  }
}

}  // namespace tessera::apps
