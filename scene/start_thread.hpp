// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <exception>
#include <optional>
#include <system_error>
#include <thread>
#include <utility>

#include "scene/error.hpp"

namespace tessera::scene {

/// If `fault` says that a thread could not begin, what that is to the user: Error(system_failure). Knows what the
/// standard library and oneTBB throw.
std::optional<Error> thread_fault(const std::exception& fault);

/// A std::thread. Throws Error(system_failure) if the system gives no more threads.
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
