// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <spawn.h>
#include <sys/types.h>

#include <filesystem>
#include <initializer_list>
#include <string>
#include <vector>

namespace tessera::system {

/// How a program is to be started: its descriptors, `files`, are the caller's to plan. All its signals are at their
/// defaults, and it is abandoned with this process's outputs (system/unfinished.hpp).
class SpawnPlan {
 public:
  /// Signals that it is deaf to.
  explicit SpawnPlan(std::initializer_list<int> blocked = {});
  ~SpawnPlan();
  SpawnPlan(const SpawnPlan&) = delete;
  SpawnPlan& operator=(const SpawnPlan&) = delete;

  /// A terminal's signals do not reach it, only this process.
  void set_own_group();
  /// Returns 0, or what errno would be. `process` is set, and unfinished, if it has started.
  int start(const std::filesystem::path& program, std::vector<std::string> words, char* const* environment,
            pid_t& process);

  posix_spawn_file_actions_t files{};

 private:
  posix_spawnattr_t attributes_{};
  short flags_ = POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETSIGDEF;
};

}  // namespace tessera::system
