// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <sys/types.h>

#include <filesystem>
#include <mutex>

/// Things that would outlive this process if it ended during a run, for abandon_outputs(): files with temporary names,
/// and programs that do not notice at once that their caller has ended. Process-wide: a signal handler has no other
/// object to use.
namespace tessera::system {

/// To be held while such a file is created, renamed or removed. Not available after abandon_outputs().
[[nodiscard]] std::unique_lock<std::timed_mutex> naming_outputs();

/// Requires that lock.
void add_unfinished(const std::filesystem::path& part);
void remove_unfinished(const std::filesystem::path& part);

/// The part of abandon_outputs() that a signal handler may execute: without the lock, for the first 64 of each. The
/// process ends afterwards.
void abandon_in_handler() noexcept;

/// Requires that lock. To be called before waiting for the program's end.
void add_unfinished(pid_t program);
void remove_unfinished(pid_t program);

}  // namespace tessera::system
