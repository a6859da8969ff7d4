// How long a frame goes on after it was asked to stop, at random times, through the public interface:
//   stop_times FILE [STOPS] [WIDTH]    prints milliseconds at 50, 95, 99 and 100 per cent of the stops
// Ends with status 1 if a frame after a stop has other bits than one that was not.
#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <random>
#include <thread>
#include <vector>

#include "tessera/tessera.hpp"

using Clock = std::chrono::steady_clock;

int main(int argc, char** argv) try {
  if (argc < 2) throw tessera::Error(tessera::ErrorCode::bad_input, "arguments: name a mesh or grid");
  const int stops = argc > 2 ? std::atoi(argv[2]) : 1000, width = argc > 3 ? std::atoi(argv[3]) : 1024;
  const tessera::Dataset data = tessera::Dataset::open(argv[1]);
  const tessera::View view{data.default_camera({width, width}), {width, width}};
  const tessera::TransferFunction function = data.transfer_function().function;
  tessera::Session session(data);
  session.render(view, function);
  const tessera::RenderedFrame whole = session.render(view, function);

  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> anywhere(0, whole.statistics.milliseconds);
  std::vector<double> times;
  int differing = 0;
  while (static_cast<int>(times.size()) < stops) {
    std::stop_source source;
    std::atomic<Clock::rep> asked = 0;
    const auto delay = std::chrono::duration<double, std::milli>(anywhere(random));
    std::jthread stopper([&] {
      std::this_thread::sleep_for(delay);
      asked = Clock::now().time_since_epoch().count();
      source.request_stop();
    });
    const tessera::RenderedFrame frame = session.render(view, function, {}, nullptr, source.get_token());
    const auto end = Clock::now();
    stopper.join();
    if (!frame.stopped) {
      differing += frame.image.rgba != whole.image.rgba || frame.image.depth != whole.image.depth ? 1 : 0;
      continue;
    }
    times.push_back(1e3 * std::chrono::duration<double>(end - Clock::time_point(Clock::duration(asked))).count());
    if (times.size() % 50 != 0) continue;
    const tessera::RenderedFrame next = session.render(view, function);
    differing += next.image.rgba != whole.image.rgba || next.image.depth != whole.image.depth ? 1 : 0;
  }
  std::sort(times.begin(), times.end());
  const auto at = [&](double part) {
    return times[static_cast<std::size_t>(part * static_cast<double>(times.size() - 1))];
  };
  std::printf(
      "frame %.0f ms; %zu stops, ms until render() returns: median %.2f, 95 %% %.2f, 99 %% %.2f, all %.2f; frames "
      "after a stop that differ: %d\n",
      whole.statistics.milliseconds, times.size(), at(0.5), at(0.95), at(0.99), at(1), differing);
  return differing == 0 ? 0 : 1;
} catch (const tessera::Error& error) {
  std::fprintf(stderr, "stop_times: %s\n", error.what());
  return static_cast<int>(error.code());
}
