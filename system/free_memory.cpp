// SPDX-License-Identifier: BSD-3-Clause
#include "system/free_memory.hpp"

#include <algorithm>
#include <fstream>
#include <string>

namespace tessera::system {

namespace {

/// Bytes that the process's control group (a container or job) may still allocate, including memory for cached files,
/// which can be freed.
std::uint64_t left_in_group() {
  std::uint64_t most = 0, used = 0, cached = 0;
  // The file contains "max", which is not a number, if there is no limit.
  if (!(std::ifstream("/sys/fs/cgroup/memory.max") >> most) ||
      !(std::ifstream("/sys/fs/cgroup/memory.current") >> used))
    return UINT64_MAX;
  std::ifstream facts("/sys/fs/cgroup/memory.stat");
  for (std::string word; facts >> word && word != "file";) facts >> word;
  facts >> cached;
  return most + cached > used ? most + cached - used : 0;
}

std::uint64_t left_in_machine() {
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

}  // namespace

std::uint64_t available_memory() { return std::min(left_in_group(), left_in_machine()); }

}  // namespace tessera::system
