// SPDX-License-Identifier: BSD-3-Clause
// Rights that reader programs give up.
#include "readers/common/sandbox.hpp"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <linux/seccomp.h>
#include <netinet/in.h>
#include <sys/mman.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstdint>
#include <functional>
#include <string>
#include <thread>
#include <vector>

#include "support/temporary_folder.hpp"

namespace tessera::readers {
namespace {

bool kernel_has_it() {
  std::uint32_t action = SECCOMP_RET_ERRNO;
  return !is_sanitized && ::syscall(SYS_seccomp, SECCOMP_GET_ACTION_AVAIL, 0, &action) == 0;
}

/// Executes `attempts` in a process that has given up its rights; returns the number of the first that returns false,
/// or -1.
int first_that_fails(MayFork may_fork, const std::vector<std::function<bool()>>& attempts) {
  const pid_t child = ::fork();
  if (child == 0) {
    give_up_rights(may_fork);
    for (std::size_t k = 0; k < attempts.size(); ++k)
      if (!attempts[k]()) ::_exit(static_cast<int>(k));
    ::_exit(255);
  }
  int status = 0;
  EXPECT_EQ(::waitpid(child, &status, 0), child);
  EXPECT_TRUE(WIFEXITED(status)) << "it ended by signal " << WTERMSIG(status);
  return WEXITSTATUS(status) == 255 ? -1 : WEXITSTATUS(status);
}

bool is_refused(long result) { return result < 0 && (errno == EACCES || errno == ENOSYS); }

TEST(Sandbox, PreventsAReaderFromChangingAnything) {
  if (!kernel_has_it()) GTEST_SKIP() << "no seccomp filters here";
  const test::TemporaryFolder folder;
  const std::string file = folder.write("kept", "words").string(), other = (folder / "new").string();
  const pid_t parent = ::getpid();
  const std::vector<std::function<bool()>> attempts = {
      [&] { return is_refused(::open(file.c_str(), O_WRONLY)); },
      [&] { return is_refused(::open(file.c_str(), O_RDWR)); },
      [&] { return is_refused(::open(file.c_str(), O_RDONLY | O_TRUNC)); },
      [&] { return is_refused(::open(other.c_str(), O_CREAT | O_WRONLY, 0600)); },
      [&] { return is_refused(::open(folder.path().c_str(), O_TMPFILE | O_RDWR, 0600)); },
      [&] { return is_refused(::creat(other.c_str(), 0600)); },
      [&] { return is_refused(::truncate(file.c_str(), 1)); },
      [&] { return is_refused(::unlink(file.c_str())); },
      [&] { return is_refused(::rename(file.c_str(), other.c_str())); },
      [&] { return is_refused(::link(file.c_str(), other.c_str())); },
      [&] { return is_refused(::symlink(file.c_str(), other.c_str())); },
      [&] { return is_refused(::mkdir(other.c_str(), 0700)); },
      [&] { return is_refused(::chmod(file.c_str(), 0777)); },
      [&] { return is_refused(::mkfifo(other.c_str(), 0600)); },
      [&] { return is_refused(::socket(AF_INET, SOCK_STREAM, 0)); },
      [&] { return is_refused(::socket(AF_INET, SOCK_DGRAM, 0)); },
      [&] { return is_refused(::socket(AF_UNIX, SOCK_STREAM, 0)); },
      [&] { return is_refused(::execl("/bin/true", "true", nullptr)); },
      [&] { return is_refused(::fork()); },
      [&] { return is_refused(::kill(parent, 0)); },
  };
  EXPECT_EQ(first_that_fails(MayFork::no, attempts), -1) << "the attempt of that number was not refused";
  EXPECT_EQ(test::contents(file), "words");
  EXPECT_EQ(folder.names(), std::vector<std::string>{"kept"});
}

TEST(Sandbox, LeavesAReaderWhatItNeeds) {
  const test::TemporaryFolder folder;
  const std::string file = folder.write("kept", "words").string();
  const std::vector<std::function<bool()>> attempts = {
      [&] { return test::contents(file) == "words"; },
      [&] {
        const int memory = ::memfd_create("numbers", MFD_CLOEXEC);
        return memory >= 0 && ::write(memory, "1", 1) == 1 && ::ftruncate(memory, 0) == 0;
      },
      [&] {
        bool has_run = false;
        std::thread([&] { has_run = true; }).join();
        return has_run;
      },
      [&] { return ::kill(::getpid(), 0) == 0; },
      [&] {
        const pid_t child = ::fork();
        if (child == 0) ::_exit(0);
        return child > 0 && ::waitpid(child, nullptr, 0) == child;
      },
  };
  EXPECT_EQ(first_that_fails(MayFork::yes, attempts), -1) << "the attempt of that number failed";
}

}  // namespace
}  // namespace tessera::readers
