// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <spawn.h>
#include <sys/types.h>

#include <filesystem>
#include <initializer_list>
#include <string>
#include <vector>

namespace tessera::system {

/// A plan for starting a program. The caller sets up the program's descriptors in `files`. In the program all signals
/// have their default action. The program is ended by abandon_outputs() (system/unfinished.hpp).
class SpawnPlan {
 public:
  /// `blocked` contains the signals that are blocked in the child.
  explicit SpawnPlan(std::initializer_list<int> blocked = {});
  ~SpawnPlan();
  SpawnPlan(const SpawnPlan&) = delete;
  SpawnPlan& operator=(const SpawnPlan&) = delete;

  /// Starts the child in its own process group, so that signals from a terminal reach only this process.
  void set_own_group();
  /// Starts the program. Returns 0 or an errno value. If the program has started, `process` is set and registered as
  /// unfinished.
  int start(const std::filesystem::path& program, std::vector<std::string> words, char* const* environment,
            pid_t& process);

  posix_spawn_file_actions_t files{};

 private:
  posix_spawnattr_t attributes_{};
  short flags_ = POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETSIGDEF;
};

}  // namespace tessera::system
