#include "apps/picture_queue.hpp"

#include <utility>

namespace tessera::apps {

PictureQueue::PictureQueue(bool behind) {
  if (behind) thread_ = std::thread([this] { run(); });
}

PictureQueue::~PictureQueue() {
  if (!thread_.joinable()) return;
  {
    const std::lock_guard lock(mutex_);
    ends_ = true;
  }
  changed_.notify_all();
  thread_.join();
}

void PictureQueue::add(Write write) {
  if (!thread_.joinable()) return write();
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [this] { return thrown_ || waiting_.size() < most_waiting; });
  if (thrown_) std::rethrow_exception(thrown_);
  waiting_.push_back(std::move(write));
  changed_.notify_all();
}

void PictureQueue::finish() {
  if (!thread_.joinable()) return;
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [this] { return thrown_ || (waiting_.empty() && !busy_); });
  if (thrown_) std::rethrow_exception(thrown_);
}

void PictureQueue::run() {
  std::unique_lock lock(mutex_);
  while (true) {
    changed_.wait(lock, [this] { return ends_ || !waiting_.empty(); });
    if (waiting_.empty()) return;
    busy_ = true;
    {
      const Write write = std::move(waiting_.front());  // its picture goes with it, before the next is let in
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
        thrown_ = thrown;
        waiting_.clear();
      }
    }
    busy_ = false;
    changed_.notify_all();
  }
}

}  // namespace tessera::apps
