// SPDX-License-Identifier: BSD-3-Clause
#include "server/serve.hpp"

#include <fmt/format.h>

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <thread>

#include "server/access.hpp"
#include "server/signals.hpp"
#include "tessera/error.hpp"

namespace tessera::server {
namespace {

/// A launcher kills ranks a second after SIGTERM. A rank that is still working must report within half of this time.
constexpr std::chrono::milliseconds patience(500);

/// Returns an address as part of a URL: IPv6 in brackets, and the loopback address instead of the address that means
/// all addresses of a machine.
std::string web_host(const std::string& address) {
  if (address == "0.0.0.0" || address == "::") return "127.0.0.1";
  return address.find(':') == std::string::npos ? address : "[" + address + "]";
}

/// Calls `late` unless the run ends within `patience` after hurry(). A run may not end because some work cannot be
/// stopped, or because a rank has died and does not respond. A launcher sends the same signal to all ranks when the
/// user ends the job and when a rank has died.
class EndWatch {
 public:
  explicit EndWatch(std::function<void()> late) : late_(std::move(late)) {}
  ~EndWatch() {
    {
      const std::lock_guard lock(mutex_);
      ended_ = true;
    }
    changed_.notify_all();
    if (thread_.joinable()) thread_.join();
  }
  EndWatch(const EndWatch&) = delete;
  EndWatch& operator=(const EndWatch&) = delete;

  void hurry() {
    thread_ = std::thread([this] {
      std::unique_lock lock(mutex_);
      if (changed_.wait_for(lock, patience, [this] { return ended_; })) return;
      lock.unlock();
      late_();
    });
  }

 private:
  std::function<void()> late_;
  std::mutex mutex_;
  std::condition_variable changed_;
  bool ended_ = false;
  std::thread thread_;
};

void follow(const ServeOptions& options, SceneReader& reader, Job& job, const ServeEvents& events) {
  Stage stage(
      reader, job, options.renderer.memory_bytes, [] {}, [](const Reading& /*reading*/) {});
  EndWatch watch([&] { events.rank_lost(); });
  const Signals signals([&] { watch.hurry(); }, events.hurried);
  stage.follow();
}

}  // namespace

void serve(const ServeOptions& options, SceneReader& reader, Job& job, const ServeEvents& events) {
  if (job.rank() != 0) return follow(options, reader, job, events);
  const Access access(options.network.address, options.allowed_hosts);
  Renderer renderer(reader, job, options.renderer);
  Listener listener(options.network, access, renderer);
  EndWatch watch([&] {
    const bool is_lost = job.size() > 1 && !renderer.is_reading();
    renderer.announce_end(is_lost ? "A rank of the server was lost; start it again." : "The server was ended.");
    listener.finish();
    is_lost ? events.rank_lost() : events.ended_at_work();
  });
  const Signals signals(
      [&] {
        renderer.end();
        watch.hurry();
      },
      events.hurried);
  events.listening(fmt::format("{}://{}:{}/?token={}", options.network.certificate.empty() ? "http" : "https",
                               web_host(options.network.address), listener.port(), access.token()));
  try {
    renderer.run();
  } catch (...) {
    renderer.end();
    renderer.announce_end(reader.worded(error_of(std::current_exception()).what()));
    listener.finish();
    throw;
  }
  renderer.announce_end("The server was ended.");
  listener.finish();
  if (renderer.is_reading()) events.ended_at_work();
}

}  // namespace tessera::server
