// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <spawn.h>
#include <sys/types.h>

#include <filesystem>
#include <initializer_list>
#include <string>
#include <vector>

namespace tessera::system {

/// How to start a program. The caller sets up its descriptors, `files`. All signals have their default action, and it
/// is abandoned with this process's outputs (system/unfinished.hpp).
class SpawnPlan {
 public:
  /// `blocked`: signals blocked in the child.
  explicit SpawnPlan(std::initializer_list<int> blocked = {});
  ~SpawnPlan();
  SpawnPlan(const SpawnPlan&) = delete;
  SpawnPlan& operator=(const SpawnPlan&) = delete;

  /// Signals from a terminal then reach only this process, not the child.
  void set_own_group();
  /// Returns 0 or an errno value. If the program has started, `process` is set and registered as unfinished.
  int start(const std::filesystem::path& program, std::vector<std::string> words, char* const* environment,
            pid_t& process);

  posix_spawn_file_actions_t files{};

 private:
  posix_spawnattr_t attributes_{};
  short flags_ = POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETSIGDEF;
};

}  // namespace tessera::system
