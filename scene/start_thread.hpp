// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <exception>
#include <optional>
#include <system_error>
#include <thread>
#include <utility>

#include "scene/error.hpp"

namespace tessera::scene {

/// If `fault` reports that a thread could not be started, returns an Error(system_failure) for the user; otherwise
/// returns no value. Recognizes the exceptions of the standard library and of oneTBB.
std::optional<Error> thread_fault(const std::exception& fault);

/// Starts a std::thread. Throws Error(system_failure) if the system does not provide more threads.
template <class Work>
std::thread start_thread(Work&& work) {
  try {
    return std::thread(std::forward<Work>(work));
  } catch (const std::system_error& fault) {
    if (const auto error = thread_fault(fault)) throw Error(*error);
    throw;
  }
}

}  // namespace tessera::scene
