#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <string_view>
#include <type_traits>

namespace tessera {

/// What a frame of a mesh took, counted. Processes send it as it stands (exchange/wire.hpp); frame_counters says how
/// they are put together and what reports and docs/GUIDE.md say of them.
struct FrameCounters {
  std::uint64_t tets_total = 0;
  std::uint64_t tets_invisible = 0;
  std::uint64_t tets_outside_view = 0;
  std::uint64_t tets_between_pixels = 0;
  std::uint64_t tets_projected = 0;
  std::uint64_t segments = 0;
  std::uint64_t max_segments_alive = 0;
  std::uint64_t peak_buffer_bytes = 0;
  std::uint64_t exact_sign_tests = 0;
  std::uint64_t unpaired = 0;
  std::uint64_t tiles_split = 0;
  std::uint64_t deep_samples = 0;
  std::uint64_t fragments = 0;
  std::uint64_t exchange_bytes = 0;
  std::uint64_t exchange_messages = 0;

  FrameCounters& operator+=(const FrameCounters& other);
};

/// A counter's name in reports, how those of several processes are put together, and what it counts.
struct FrameCounter {
  enum class Together { sum, largest };
  std::string_view name;
  std::uint64_t FrameCounters::*member;
  Together together;
  bool if_any;  ///< reports leave it out where it is 0
  std::string_view meaning;
};

/// All of them, in the order of reports. tets_total is the sum of the four that follow.
inline constexpr std::array<FrameCounter, 15> frame_counters{{
    {"tets_total", &FrameCounters::tets_total, FrameCounter::Together::sum, false, "tetrahedra of the mesh"},
    {"tets_invisible", &FrameCounters::tets_invisible, FrameCounter::Together::sum, false,
     "never projected: the transfer function is zero over all of their scalars"},
    {"tets_outside_view", &FrameCounters::tets_outside_view, FrameCounter::Together::sum, false,
     "of the rest, outside the picture or the clipping range"},
    {"tets_between_pixels", &FrameCounters::tets_between_pixels, FrameCounter::Together::sum, false,
     "of the rest, too small to cover the centre of any pixel"},
    {"tets_projected", &FrameCounters::tets_projected, FrameCounter::Together::sum, false, "what is left"},
    {"segments", &FrameCounters::segments, FrameCounter::Together::sum, false,
     "ray segments composited, or left out behind opaque ones"},
    {"max_segments_alive", &FrameCounters::max_segments_alive, FrameCounter::Together::largest, false,
     "most segments that one thread held at once"},
    {"peak_buffer_bytes", &FrameCounters::peak_buffer_bytes, FrameCounter::Together::sum, false,
     "most bytes of frame buffers held at once, estimated from capacities"},
    {"exact_sign_tests", &FrameCounters::exact_sign_tests, FrameCounter::Together::sum, false,
     "edge signs that exact arithmetic decided"},
    {"unpaired", &FrameCounters::unpaired, FrameCounter::Together::sum, false,
     "scanline: front-face fragments lost for want of a back-face one"},
    {"tiles_split", &FrameCounters::tiles_split, FrameCounter::Together::sum, false,
     "tiles worked through in parts to stay within the memory budget"},
    {"deep_samples", &FrameCounters::deep_samples, FrameCounter::Together::sum, true, "of the deep picture"},
    {"fragments", &FrameCounters::fragments, FrameCounter::Together::sum, true,
     "runs or segments that projectors sent to compositors"},
    {"exchange_bytes", &FrameCounters::exchange_bytes, FrameCounter::Together::sum, true,
     "of the messages they went in, those to the same process included"},
    {"exchange_messages", &FrameCounters::exchange_messages, FrameCounter::Together::sum, true, "how many"},
}};
static_assert(sizeof(FrameCounters) == frame_counters.size() * sizeof(std::uint64_t), "a counter is not in the list");
static_assert(std::is_trivially_copyable_v<FrameCounters>, "processes send it as it stands");

inline FrameCounters& FrameCounters::operator+=(const FrameCounters& other) {
  for (const FrameCounter& c : frame_counters) {
    const std::uint64_t mine = this->*c.member, theirs = other.*c.member;
    this->*c.member = c.together == FrameCounter::Together::sum ? mine + theirs : std::max(mine, theirs);
  }
  return *this;
}

}  // namespace tessera
