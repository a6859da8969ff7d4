#include "scene/start_thread.hpp"

#include <fmt/format.h>

#include <fstream>
#include <string>
#include <string_view>

namespace tessera::scene {
namespace {

/// Threads of this process; 0 if the system does not say.
int threads_running() {
  std::ifstream status("/proc/self/status");
  for (std::string word; status >> word;)
    if (word == "Threads:") {
      int count = 0;
      status >> count;
      return count;
    }
  return 0;
}

}  // namespace

std::optional<Error> thread_fault(const std::exception& fault) {
  const auto* system = dynamic_cast<const std::system_error*>(&fault);
  const bool of_std = system != nullptr && system->code() == std::errc::resource_unavailable_try_again;
  // oneTBB has no type of its own for this.
  const bool of_tbb = std::string_view(fault.what()).starts_with("pthread_create has failed");
  if (!of_std && !of_tbb) return std::nullopt;
  return Error(ErrorCode::system_failure,
               fmt::format("threads: the system starts no more than the {} of this process; lower `threads`, or raise "
                           "the limits on memory and processes (ulimit -v, ulimit -u)",
                           threads_running()));
}

}  // namespace tessera::scene
