#include "io/free_memory.hpp"

#include <fstream>
#include <string>

namespace tessera::io {

std::uint64_t available_memory() {
  std::ifstream facts("/proc/meminfo");
  std::string word;
  while (facts >> word)
    if (word == "MemAvailable:") {
      std::uint64_t kilobytes = 0;
      if (facts >> kilobytes) return kilobytes * 1024;
      break;
    }
  return UINT64_MAX;
}

}  // namespace tessera::io
