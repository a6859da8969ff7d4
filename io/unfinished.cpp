#include "io/unfinished.hpp"

#include <csignal>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <vector>

#include "tessera/output_file.hpp"

namespace tessera::io {
namespace {

struct Unfinished {
  std::timed_mutex naming;
  std::vector<std::filesystem::path> parts;
  std::vector<pid_t> programs;
};

/// Never destroyed: a signal may come while the process ends.
Unfinished& unfinished() {
  static auto* const all = new Unfinished;
  return *all;
}

}  // namespace

std::unique_lock<std::timed_mutex> naming_outputs() { return std::unique_lock(unfinished().naming); }

void add_unfinished(const std::filesystem::path& part) { unfinished().parts.push_back(part); }
void remove_unfinished(const std::filesystem::path& part) { std::erase(unfinished().parts, part); }
void add_unfinished(pid_t program) { unfinished().programs.push_back(program); }
void remove_unfinished(pid_t program) { std::erase(unfinished().programs, program); }

}  // namespace tessera::io

namespace tessera {

void abandon_outputs() noexcept {
  io::Unfinished& all = io::unfinished();
  // A file system that does not answer must not keep the process: then its files stay.
  std::unique_lock lock(all.naming, std::chrono::seconds(1));
  if (!lock.owns_lock()) return;
  for (const std::filesystem::path& part : all.parts) ::unlink(part.c_str());
  for (const pid_t program : all.programs) ::kill(program, SIGKILL);
  static_cast<void>(lock.release());  // locked for good
}

}  // namespace tessera
