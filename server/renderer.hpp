// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <atomic>
#include <memory>
#include <mutex>
#include <optional>
#include <string>

#include "server/api.hpp"
#include "server/scene_reader.hpp"
#include "server/service.hpp"
#include "server/stage.hpp"
#include "server/work_queue.hpp"

namespace tessera::server {

/// Settings for answering the requests of a server, except for its data.
struct RendererSettings {
  double latency_ms = 100;
  std::uint64_t memory_bytes = 4ull << 30;  ///< limit for the data sets that are kept
  int threads = 0;
};

/// Renders for all clients of a server, on the thread that calls run(). In a job of one rank, images, films and other
/// long work are done on a second thread, so that views can be rendered at any time.
class Renderer final : public Service {
 public:
  Renderer(SceneReader& reader, Job& job, const RendererSettings& settings);
  ~Renderer() override;

  /// Runs until end() is called and, in a job of several ranks, all ranks have ended. Throws errors that end the run of
  /// all ranks.
  void run();
  /// Makes run() return soon. May be called from any thread.
  void end();
  /// Sends the reason why the server ends to the clients.
  void announce_end(const std::string& reason);
  [[nodiscard]] bool is_reading() { return stage_.reading().has_value(); }

  void answer(Request request, std::stop_token gone, Reply reply) override;
  ClientId join(std::shared_ptr<Channel> channel) override;
  void message(ClientId client, const std::string& text) override;
  void leave(ClientId client) override;

 private:
  FrameOutcome render(const FrameOrder& order);
  FrameOutcome make_frame(const FrameOrder& order);
  /// Reads the data with which the server was started.
  void read_first();
  void report_reading(const Reading& reading);
  void data_arrived();

  SceneReader& reader_;
  RendererSettings settings_;
  WorkQueue queue_, long_queue_;
  Stage stage_;
  Precedence precedence_;
  LongProgress film_, picture_;
  std::atomic<bool> first_arrived_ = false;
  std::uint64_t frames_ = 0;
  Clock::time_point reading_reported_;
};

}  // namespace tessera::server
