// SPDX-License-Identifier: BSD-3-Clause
#include "scene/start_thread.hpp"

#include <fmt/format.h>

#include <fstream>
#include <new>
#include <string>
#include <string_view>

namespace tessera::scene {
namespace {

/// Number of threads of this process; 0 if the system does not report it.
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
  // oneTBB does not have an exception type for this error.
  const bool of_tbb = std::string_view(fault.what()).starts_with("pthread_create has failed");
  if (!of_std && !of_tbb) return std::nullopt;
  return Error(ErrorCode::system_failure,
               fmt::format("threads: the system does not start more threads than the {} of this process; lower "
                           "`threads`, or raise the limits on memory and processes (ulimit -v, ulimit -u)",
                           threads_running()));
}

}  // namespace tessera::scene

namespace tessera {
inline namespace v0_1 {

Error error_of(const std::exception_ptr& thrown) {
  try {
    std::rethrow_exception(thrown);
  } catch (const Error& error) {
    return error;
  } catch (const std::bad_alloc&) {
    return {ErrorCode::system_failure,
            "memory: this run needs more memory than is available; make `size` smaller or use a machine with more"};
  } catch (const std::exception& fault) {
    if (const auto of_threads = scene::thread_fault(fault)) return *of_threads;
    return {ErrorCode::system_failure, fmt::format("unexpected: {}; please report", fault.what())};
  } catch (...) {
    return {ErrorCode::system_failure, "unexpected: unknown exception; please report"};
  }
}

}  // namespace v0_1
}  // namespace tessera
