// SPDX-License-Identifier: BSD-3-Clause
// How long a frame continues after a stop was requested, at random times, through the public interface:
//   stop_times FILE [STOPS] [WIDTH] [compute|fragment]   prints ms at 50, 95, 99 and 100 per cent of the stops
//   mpirun -n 4 stop_times ...   ranks request in turn, and the last to return counts
// The last argument makes OpenGL (OSMesa) composite. Exits with status 1 if a frame after a stop differs in any bit
// from one without.
#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <random>
#include <string>
#include <thread>
#include <vector>

#include "tessera/tessera.hpp"

namespace {

using Clock = std::chrono::steady_clock;  // shared by all processes of a machine

/// The value of rank `root`.
Clock::rep shared(tessera::Job& job, int root, Clock::rep value) {
  std::vector<std::byte> bytes(sizeof value);
  std::memcpy(bytes.data(), &value, sizeof value);
  bytes = job.broadcast(root, std::move(bytes));
  std::memcpy(&value, bytes.data(), sizeof value);
  return value;
}

struct Asked {
  std::string file;
  int stops = 1000, width = 1024;
  tessera::Settings settings;
};

int measure(tessera::Job& job, const Asked& asked) {
  const std::vector<std::filesystem::path> files{asked.file};
  const tessera::Dataset data =
      job.size() > 1 ? tessera::Dataset::open(files, {}, job.communicator()) : tessera::Dataset::open(asked.file);
  const tessera::View view = data.default_view({asked.width, asked.width});
  const tessera::TransferFunction function = data.transfer_function().function;
  tessera::Session session(data, asked.settings, job.communicator());
  session.render(view, function);
  const tessera::RenderedFrame whole = session.render(view, function);
  const double frame_ms =
      1e-6 * static_cast<double>(shared(job, 0, static_cast<Clock::rep>(1e6 * whole.statistics.milliseconds)));

  std::mt19937_64 random(1);  // the same on all ranks
  std::uniform_real_distribution<double> anywhere(0, frame_ms);
  std::vector<double> times;
  int differing = 0;
  const auto compare = [&](const tessera::RenderedFrame& frame) {
    differing += frame.image.rgba != whole.image.rgba || frame.image.depth != whole.image.depth ? 1 : 0;
  };
  for (int round = 0; static_cast<int>(times.size()) < asked.stops; ++round) {
    const int asking = round % job.size();
    const auto delay = std::chrono::duration<double, std::milli>(anywhere(random));
    std::stop_source source;
    std::atomic<Clock::rep> asked_at = 0;
    std::jthread stopper;
    if (job.rank() == asking)
      stopper = std::jthread([&] {
        std::this_thread::sleep_for(delay);
        asked_at = Clock::now().time_since_epoch().count();
        source.request_stop();
      });
    const tessera::RenderedFrame frame = session.render(view, function, {}, nullptr, source.get_token());
    const Clock::rep end = Clock::now().time_since_epoch().count();
    if (stopper.joinable()) stopper.join();
    const Clock::rep begin = shared(job, asking, asked_at);
    Clock::rep last = 0;
    for (int rank = 0; rank < job.size(); ++rank) last = std::max(last, shared(job, rank, end));
    if (shared(job, 0, frame.stopped ? 1 : 0) == 0) {
      compare(frame);
      continue;
    }
    times.push_back(1e3 * std::chrono::duration<double>(Clock::duration(last - begin)).count());
    if (times.size() % 50 == 0) compare(session.render(view, function));
  }
  std::sort(times.begin(), times.end());
  const auto at = [&](double part) {
    return times[static_cast<std::size_t>(part * static_cast<double>(times.size() - 1))];
  };
  if (job.rank() == 0)
    std::printf(
        "frame %.0f ms; %zu stops, ms until render() returns: median %.2f, 95 %% %.2f, 99 %% %.2f, all %.2f; frames "
        "after a stop that differ: %d\n",
        frame_ms, times.size(), at(0.5), at(0.95), at(0.99), at(1), differing);
  return differing == 0 ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) try {
  tessera::Job job({"stop_times", "run it again",
                    [](const tessera::Error& error) { std::fprintf(stderr, "stop_times: %s\n", error.what()); }});
  if (argc < 2) throw tessera::Error(tessera::ErrorCode::bad_input, "arguments: name a mesh or grid");
  Asked asked;
  asked.file = argv[1];
  if (argc > 2) asked.stops = std::atoi(argv[2]);
  if (argc > 3) asked.width = std::atoi(argv[3]);
  if (argc > 4) {
    asked.settings.mesh.device.backends = {tessera::Backend::osmesa};
    asked.settings.mesh.device.method =
        std::strcmp(argv[4], "fragment") == 0 ? tessera::GlMethod::fragment : tessera::GlMethod::compute;
  }
  const int status = measure(job, asked);
  return job.finish() ? 1 : status;
} catch (const tessera::Error& error) {
  std::fprintf(stderr, "stop_times: %s\n", error.what());
  return static_cast<int>(error.code());
}
