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

/// What a server's requests are answered with, beside its data.
struct RendererSettings {
  double latency_ms = 100;
  std::uint64_t memory_bytes = 4ull << 30;  ///< of data sets that are kept
  int threads = 0;
};

/// Renders for all clients of a server, on the thread that calls run(); pictures, films and other long work, where
/// there is one rank, on a second one, so that views have their turn at any time.
class Renderer final : public Service {
 public:
  Renderer(SceneReader& reader, Job& job, const RendererSettings& settings);
  ~Renderer() override;

  /// Until end() is called, and on several ranks all have come to their end. Throws what ends the run of all ranks.
  void run();
  /// From any thread: run() returns soon.
  void end();
  /// Tells clients why the server ends.
  void say_end(const std::string& reason);
  [[nodiscard]] bool is_reading() { return stage_.reading().has_value(); }

  void answer(Request request, std::stop_token gone, Reply reply) override;
  ClientId join(std::shared_ptr<Channel> channel) override;
  void message(ClientId client, const std::string& text) override;
  void leave(ClientId client) override;

 private:
  FrameOutcome render(const FrameOrder& order);
  FrameOutcome make_frame(const FrameOrder& order);
  /// What the server begins with is read at once.
  void read_first();
  void say_reading(const Reading& reading);
  void data_came();

  SceneReader& reader_;
  RendererSettings settings_;
  WorkQueue queue_, long_queue_;
  Stage stage_;
  Precedence precedence_;
  LongProgress film_, picture_;
  std::atomic<bool> first_came_ = false;
  std::uint64_t frames_ = 0;
  Clock::time_point told_reading_;
};

}  // namespace tessera::server
