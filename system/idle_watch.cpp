// SPDX-License-Identifier: BSD-3-Clause
#include "system/idle_watch.hpp"

#include <fmt/format.h>

#include <ctime>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <system_error>

namespace tessera::system {
namespace {

/// According to proc(5), the state follows the name of the program. The name is in parentheses and may itself contain
/// parentheses.
bool all_threads_sleep(pid_t process) {
  std::error_code unknown;
  std::filesystem::directory_iterator thread(fmt::format("/proc/{}/task", process), unknown);
  for (; !unknown && thread != std::filesystem::directory_iterator(); thread.increment(unknown)) {
    std::ifstream file(thread->path() / "stat");
    const std::string text(std::istreambuf_iterator<char>(file), {});
    const std::size_t end = text.rfind(')');
    if (end == std::string::npos || text.substr(end, 3) != ") S") return false;
  }
  return !unknown;
}

std::int64_t processor_time(pid_t process) {
  clockid_t clock{};
  timespec used{};
  if (::clock_getcpuclockid(process, &clock) != 0 || ::clock_gettime(clock, &used) != 0) return -1;
  return used.tv_sec * 1'000'000'000LL + used.tv_nsec;
}

}  // namespace

std::chrono::steady_clock::duration IdleWatch::look() {
  const auto now = std::chrono::steady_clock::now();
  const std::int64_t used = processor_time(process_);
  if (used < 0 || used != used_ || !all_threads_sleep(process_)) {
    used_ = used;
    since_ = now;
  }
  return now - since_;
}

}  // namespace tessera::system
