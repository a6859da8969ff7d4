// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <sys/types.h>

#include <filesystem>
#include <mutex>

/// What would outlive this process if it ended in mid-run, for abandon_outputs(): files under a temporary name, and
/// programs that do not see at once that their caller is gone. Of the process; there is no other owner that a signal
/// could be answered by.
namespace tessera::system {

/// Whoever makes, renames or removes such a file holds this meanwhile. Not to be had any more after abandon_outputs().
[[nodiscard]] std::unique_lock<std::timed_mutex> naming_outputs();

/// With that lock held.
void add_unfinished(const std::filesystem::path& part);
void remove_unfinished(const std::filesystem::path& part);

/// What abandon_outputs() does, as far as a signal's handler may: without the lock, of the first 64 of each. The
/// process ends after it.
void abandon_in_handler() noexcept;

/// With that lock held, before its end is waited for.
void add_unfinished(pid_t program);
void remove_unfinished(pid_t program);

}  // namespace tessera::system
