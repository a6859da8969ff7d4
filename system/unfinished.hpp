// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <sys/types.h>

#include <filesystem>
#include <mutex>

/// Files and programs that would remain if this process ended during a run, for abandon_outputs(): files with temporary
/// names, and programs that do not notice at once that their caller has ended. The list is global, because a signal
/// handler cannot access any other object.
namespace tessera::system {

/// Returns the lock that must be held while a file with a temporary name is created, renamed or removed. After
/// abandon_outputs(), the lock is not available.
[[nodiscard]] std::unique_lock<std::timed_mutex> naming_outputs();

/// Register and unregister a file. The lock of naming_outputs() must be held.
void add_unfinished(const std::filesystem::path& part);
void remove_unfinished(const std::filesystem::path& part);

/// The part of abandon_outputs() that a signal handler may execute. It does not use the lock and handles only the first
/// 64 files and the first 64 programs. The process must end afterwards.
void abandon_in_handler() noexcept;

/// Register and unregister a program. The lock of naming_outputs() must be held. A program must be unregistered before
/// waiting for its end.
void add_unfinished(pid_t program);
void remove_unfinished(pid_t program);

}  // namespace tessera::system
