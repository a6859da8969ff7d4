// SPDX-License-Identifier: BSD-3-Clause
#include "frame/grid/volume_frames.hpp"

#include <chrono>
#include <condition_variable>
#include <ctime>
#include <deque>
#include <exception>
#include <mutex>
#include <thread>
#include <utility>

#include "exchange/collectives.hpp"
#include "frame/grid/region_gather.hpp"
#include "frame/ranks/run_error.hpp"
#include "scene/start_thread.hpp"

namespace tessera::frame {

using exchange::MessageKind;

/// The frames of one call of render(). Rank 0 gathers them and passes them on; other ranks send their parts to rank 0.
class VolumeFrames::List {
 public:
  List(exchange::Transport& transport, scene::Trace* trace, StopRelay::Run& relayed, const VolumeCallbacks& callbacks,
       std::size_t first)
      : transport_(transport), relayed_(relayed), callbacks_(callbacks), first_(first), gather_(transport, trace) {
    if (transport_.rank() == 0 && transport_.size() > 1) thread_ = scene::start_thread([this] { complete_all(); });
  }
  ~List() {
    close();
    if (thread_.joinable()) thread_.join();
  }
  List(const List&) = delete;
  List& operator=(const List&) = delete;

  /// Connects a watch to the callback for the pixels of a frame.
  void listen(std::size_t frame, scene::FrameWatch& watch) {
    if (!callbacks_.tile || transport_.rank() != 0) return;
    watch.listen([this, frame](const scene::PixelRect& rect, const scene::Image& image) {
      if (!call([&] { callbacks_.tile(frame, rect, image); })) throw scene::FrameStopped();
    });
  }

  /// On rank 0: waits until fewer than `in_flight` frames are in progress. Throws the exception that ended the
  /// gathering.
  void wait_for_room(int in_flight) {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [&] { return failed_ || given_ - left_ < static_cast<std::size_t>(in_flight); });
    if (failed_) std::rethrow_exception(failed_);
  }

  /// Passes on this rank's part of the next frame.
  void give(VolumePart part) {
    if (transport_.rank() != 0) return send_region(transport_, part);
    {
      const std::lock_guard lock(mutex_);
      ++given_;
      parts_.push_back(std::move(part));
    }
    changed_.notify_all();
    if (!thread_.joinable()) complete_next();
  }

  /// On rank 0: waits for the last frame and returns how many are complete. Throws the exception that ended the
  /// gathering.
  std::size_t end() {
    close();
    if (thread_.joinable()) thread_.join();
    if (failed_) std::rethrow_exception(failed_);
    return complete_;
  }
  /// The exception that a callback threw.
  [[nodiscard]] std::exception_ptr thrown() const { return thrown_; }

 private:
  void close() {
    {
      const std::lock_guard lock(mutex_);
      closed_ = true;
    }
    changed_.notify_all();
  }

  void complete_all() {
    try {
      while (complete_next()) {
      }
    } catch (const std::exception& fault) {
      transport_.fail(run_error(transport_, fault));
      const std::lock_guard lock(mutex_);
      failed_ = std::current_exception();
    }
    changed_.notify_all();
  }

  /// Waits for this rank's part of the next frame, then for the other ranks' parts. Returns false if there is no next
  /// frame.
  bool complete_next() {
    VolumePart part;
    {
      std::unique_lock lock(mutex_);
      changed_.wait(lock, [&] { return closed_ || !parts_.empty(); });
      if (parts_.empty()) return false;
      part = std::move(parts_.front());
      parts_.pop_front();
    }
    const std::size_t frame = part.header.frame - first_;
    scene::FrameWatch watch(relayed_.token());
    listen(frame, watch);
    FinishedVolumeFrame finished = gather_.gather(std::move(part), watch);
    finished.frame = frame;
    const auto now = std::chrono::steady_clock::now();
    finished.frame_ms = std::chrono::duration<double, std::milli>(now - std::exchange(last_, now)).count();
    hand_out(std::move(finished));
    {
      const std::lock_guard lock(mutex_);
      ++left_;
    }
    changed_.notify_all();
    return true;
  }

  void hand_out(FinishedVolumeFrame finished) {
    if (std::exchange(ended_, ended_ || finished.stopped)) return;
    const bool whole = !finished.stopped;
    if (call([&] { callbacks_.frame(std::move(finished)); }) && whole) ++complete_;
  }

  /// Returns false if this call or an earlier one threw.
  template <class Call>
  bool call(const Call& call) {
    const std::lock_guard lock(calls_);
    if (thrown_) return false;
    try {
      call();
    } catch (...) {
      thrown_ = std::current_exception();
      relayed_.stop();
    }
    return !thrown_;
  }

  exchange::Transport& transport_;
  StopRelay::Run& relayed_;
  const VolumeCallbacks& callbacks_;
  const std::size_t first_;
  RegionGather gather_;
  std::chrono::steady_clock::time_point last_ = std::chrono::steady_clock::now();  ///< when the last frame was complete
  std::size_t complete_ = 0;
  bool ended_ = false;  ///< a stopped frame has ended the list

  std::mutex calls_;
  std::exception_ptr thrown_;

  std::mutex mutex_;  // guards the members below
  std::condition_variable changed_;
  std::deque<VolumePart> parts_;
  std::size_t given_ = 0, left_ = 0;
  bool closed_ = false;
  std::exception_ptr failed_;
  std::thread thread_;  // last: it uses all of the above
};

std::size_t VolumeFrames::render(volume::Renderer& renderer, const scene::TransferFunction& function,
                                 std::span<const VolumeJob> jobs, std::size_t first, const VolumeCallbacks& callbacks,
                                 const std::stop_token& stop, int in_flight) {
  const bool alone = transport_.size() == 1, assembles = transport_.rank() == 0;
  StopRelay::Run relayed(relay_, stop);
  {
    // The time of a frame does not include reading.
    const scene::TraceScope timing(trace_, "wait", static_cast<std::int32_t>(first));
    exchange::barrier(transport_);
  }
  List list(transport_, trace_, relayed, callbacks, first);
  std::size_t complete = 0;
  try {
    for (std::size_t frame = 0; frame < jobs.size(); ++frame) {
      const auto number = static_cast<std::int32_t>(first + frame);
      if (trace_ != nullptr && jobs.size() > 1) trace_->set_frame(number);
      const double start_us = trace_ != nullptr ? trace_->now_us() : 0;
      {
        const scene::TraceScope timing(trace_, "wait", number);
        if (assembles) list.wait_for_room(in_flight);
        const bool stopped = relayed.token().stop_requested();
        // The first frame is always rendered, so that all ranks learn of a stop by the same message.
        if (frame > 0 && alone && stopped) break;
        if (frame > 0 && !alone &&
            exchange::broadcast_value(transport_, 0, MessageKind::next_frame, std::uint8_t{!stopped}) == 0)
          break;
      }
      scene::FrameWatch watch(relayed.token());
      list.listen(frame, watch);
      list.give(make(renderer, function, jobs[frame], first + frame, watch));
      if (trace_ != nullptr && jobs.size() > 1) trace_->add_frame(number, start_us);
    }
    if (assembles) complete = list.end();
    if (!alone)
      complete = exchange::broadcast_value(transport_, 0, MessageKind::frames_complete, std::uint64_t{complete});
  } catch (const std::exception& fault) {
    // The other ranks wait for this rank, and so does the gathering thread.
    if (!alone) transport_.fail(run_error(transport_, fault));
    throw;
  }
  if (list.thrown()) std::rethrow_exception(list.thrown());
  return complete;
}

std::optional<FinishedVolumeFrame> VolumeFrames::render(volume::Renderer& renderer,
                                                        const scene::TransferFunction& function, const VolumeJob& job,
                                                        std::size_t number, scene::FrameWatch* watch) {
  std::optional<FinishedVolumeFrame> made;
  VolumeCallbacks callbacks;
  callbacks.frame = [&](FinishedVolumeFrame&& frame) { made = std::move(frame), made->frame = number; };
  if (watch != nullptr && watch->wants_tiles())
    callbacks.tile = [&](std::size_t, const scene::PixelRect& rect, const scene::Image& image) {
      watch->finished(rect, image);
    };
  render(renderer, function, {&job, 1}, number, callbacks, watch != nullptr ? watch->stop() : std::stop_token(), 1);
  return made;
}

double process_cpu_seconds() {
  timespec t{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

}  // namespace tessera::frame
