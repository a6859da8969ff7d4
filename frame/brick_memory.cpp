#include "frame/brick_memory.hpp"

#include <unistd.h>

#include <algorithm>
#include <fstream>

#include "scene/threads.hpp"

namespace tessera::frame {

std::uint64_t resident_bytes() {
  std::uint64_t whole = 0, resident = 0;
  std::ifstream statm("/proc/self/statm");
  if (!(statm >> whole >> resident)) return 0;
  return resident * static_cast<std::uint64_t>(sysconf(_SC_PAGESIZE));
}

std::uint64_t brick_memory(std::uint64_t memory, std::uint64_t resident, scene::ImageSize picture, int threads) {
  constexpr std::uint64_t mib = 1 << 20, least = 16 * mib, mapped = 8 * mib, a_thread = 2 * mib;
  constexpr std::uint64_t a_pixel = 5 * sizeof(float);  // RGBA and depth
  const auto threads_here = static_cast<std::uint64_t>(scene::threads_for(threads));
  const std::uint64_t pixels = static_cast<std::uint64_t>(picture.width) * static_cast<std::uint64_t>(picture.height);
  const std::uint64_t rest = resident + 2 * a_pixel * pixels + threads_here * a_thread + mapped;
  return std::max(std::min(memory, least), memory > rest ? memory - rest : 0);
}

}  // namespace tessera::frame
