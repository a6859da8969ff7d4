// SPDX-License-Identifier: BSD-3-Clause
#include "system/files_read.hpp"

#include <sys/stat.h>

#include <atomic>
#include <mutex>
#include <set>
#include <utility>

#include "tessera/error.hpp"
#include "tessera/program/output_file.hpp"

namespace tessera::system {
namespace {

struct FilesRead {
  std::mutex mutex;
  std::set<std::pair<std::uint64_t, std::uint64_t>> identities;
  std::set<std::string> names;
};
FilesRead& files_read() {
  static FilesRead read;
  return read;
}

std::atomic<bool> inputs_are_protected = false;

}  // namespace

void note_named(const std::filesystem::path& file) {
  struct stat facts {};
  if (::stat(file.c_str(), &facts) != 0 || !S_ISREG(facts.st_mode)) return;
  const std::lock_guard lock(files_read().mutex);
  files_read().identities.emplace(facts.st_dev, facts.st_ino);
}

void note_read(const std::filesystem::path& file) {
  if (file.native().starts_with("/proc/")) return;  // an open file of this process, which has no other name
  note_named(file);
  const std::lock_guard lock(files_read().mutex);
  files_read().names.insert(file.string());
}

bool was_read(std::uint64_t device, std::uint64_t number) {
  if (!inputs_are_protected) return false;
  const std::lock_guard lock(files_read().mutex);
  return files_read().identities.contains({device, number});
}

std::vector<std::string> take_names_read() {
  const std::lock_guard lock(files_read().mutex);
  const std::set<std::string> names = std::exchange(files_read().names, {});
  return {names.begin(), names.end()};
}

}  // namespace tessera::system

namespace tessera {
inline namespace v0_1 {

void protect_inputs() { system::inputs_are_protected = true; }

void check_not_read(const std::filesystem::path& target) {
  struct stat present {};
  if (::stat(target.c_str(), &present) == 0 && system::was_read(present.st_dev, present.st_ino))
    throw Error(ErrorCode::bad_input, target.string(), "is an input of this run and would be overwritten",
                "choose another name");
}

}  // namespace v0_1
}  // namespace tessera
