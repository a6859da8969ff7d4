// SPDX-License-Identifier: BSD-3-Clause
#include "system/spawn_plan.hpp"

#include <csignal>

#include "system/unfinished.hpp"

namespace tessera::system {

SpawnPlan::SpawnPlan(std::initializer_list<int> blocked) {
  ::posix_spawn_file_actions_init(&files);
  ::posix_spawnattr_init(&attributes_);
  sigset_t blocked_set, all;
  ::sigemptyset(&blocked_set);
  for (const int signal : blocked) ::sigaddset(&blocked_set, signal);
  ::sigfillset(&all);
  ::posix_spawnattr_setsigmask(&attributes_, &blocked_set);
  ::posix_spawnattr_setsigdefault(&attributes_, &all);
}

SpawnPlan::~SpawnPlan() {
  ::posix_spawn_file_actions_destroy(&files);
  ::posix_spawnattr_destroy(&attributes_);
}

void SpawnPlan::set_own_group() {
  ::posix_spawnattr_setpgroup(&attributes_, 0);
  flags_ |= POSIX_SPAWN_SETPGROUP;
}

int SpawnPlan::start(const std::filesystem::path& program, std::vector<std::string> words, char* const* environment,
                     pid_t& process) {
  ::posix_spawnattr_setflags(&attributes_, flags_);
  std::vector<char*> arguments;
  arguments.reserve(words.size() + 1);
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  const auto lock = naming_outputs();
  const int failed = ::posix_spawn(&process, program.c_str(), &files, &attributes_, arguments.data(), environment);
  if (failed == 0) add_unfinished(process);
  return failed;
}

}  // namespace tessera::system
