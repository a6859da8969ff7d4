// SPDX-License-Identifier: BSD-3-Clause
#include "system/unfinished.hpp"

#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <vector>

#include "tessera/program/output_file.hpp"

namespace tessera::system {
namespace {

struct Unfinished {
  std::timed_mutex naming;
  std::vector<std::filesystem::path> parts;
  std::vector<pid_t> programs;
};

/// Returns the list of unfinished things. It is never destroyed, because a signal may arrive while the process ends.
Unfinished& unfinished() {
  static auto* const all = new Unfinished;
  return *all;
}

/// The names of the files in a form that a signal handler can read. The thread that replaces a name by null owns the
/// name and may free it.
std::array<std::atomic<char*>, 64> part_names{};
std::array<std::atomic<pid_t>, 64> program_numbers{};

}  // namespace

std::unique_lock<std::timed_mutex> naming_outputs() { return std::unique_lock(unfinished().naming); }

void add_unfinished(const std::filesystem::path& part) {
  unfinished().parts.push_back(part);
  const auto free = std::ranges::find(part_names, nullptr, [](const auto& name) { return name.load(); });
  if (free != part_names.end()) *free = ::strdup(part.c_str());
}

void remove_unfinished(const std::filesystem::path& part) {
  std::erase(unfinished().parts, part);
  for (std::atomic<char*>& name : part_names) {
    char* const present = name;
    if (present == nullptr || part != present) continue;
    std::free(name.exchange(nullptr));
    return;
  }
}

void add_unfinished(pid_t program) {
  unfinished().programs.push_back(program);
  const auto free = std::ranges::find(program_numbers, 0, [](const auto& number) { return number.load(); });
  if (free != program_numbers.end()) *free = program;
}

void remove_unfinished(pid_t program) {
  std::erase(unfinished().programs, program);
  const auto found = std::ranges::find(program_numbers, program, [](const auto& number) { return number.load(); });
  if (found != program_numbers.end()) *found = 0;
}

void abandon_in_handler() noexcept {
  for (std::atomic<char*>& name : part_names)
    if (const char* const part = name.exchange(nullptr); part != nullptr) ::unlink(part);
  for (std::atomic<pid_t>& number : program_numbers)
    if (const pid_t program = number.exchange(0); program > 0) ::kill(program, SIGKILL);
}

}  // namespace tessera::system

namespace tessera {
inline namespace v0_1 {

void abandon_outputs() noexcept {
  system::Unfinished& all = system::unfinished();
  // A file system that does not respond must not block the process. In this case the files remain.
  std::unique_lock lock(all.naming, std::chrono::seconds(1));
  if (!lock.owns_lock()) return;
  for (const std::filesystem::path& part : all.parts) ::unlink(part.c_str());
  for (const pid_t program : all.programs) ::kill(program, SIGKILL);
  static_cast<void>(lock.release());  // never unlocked
}

}  // namespace v0_1
}  // namespace tessera
