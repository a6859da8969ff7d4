// SPDX-License-Identifier: BSD-3-Clause
#include "exchange/termination.hpp"

#include <fmt/format.h>
#include <sys/prctl.h>
#include <sys/time.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <csignal>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <string>
#include <string_view>

#include "exchange/one_line.hpp"

// A signal handler may use only plain memory that was filled before the handler was installed, lock-free atomics, and
// system calls.
namespace tessera::exchange {
namespace {

bool speaks_for_the_lost = true;  ///< whether this rank is on rank 0's machine
std::array<pid_t, 2> launchers{};
std::string remedy_of_run, line_of_run;
void (*before_end_of_run)() noexcept = nullptr;
std::atomic<bool> is_ending = false, asked_to_end = false;

extern "C" void on_termination(int signal, siginfo_t* from, void* /*context*/) {
  if (is_ending && signal == SIGTERM) {
    const itimerval soon{{0, 0}, {1, 0}};
    setitimer(ITIMER_REAL, &soon, nullptr);
    return;
  }
  // The launcher sends the signal to all ranks and waits for none, so this rank ends at once. A signal from any other
  // process may be meant for this rank alone: the first signal makes the run end in an orderly way, a second signal
  // ends this rank at once.
  const bool from_launcher = from->si_pid == launchers[0] || from->si_pid == launchers[1];
  if (signal == SIGTERM && !from_launcher && !asked_to_end.exchange(true)) return;
  if (!is_ending && speaks_for_the_lost && may_speak()) {
    const ssize_t ignored = write(STDERR_FILENO, line_of_run.data(), line_of_run.size());
    static_cast<void>(ignored);
  }
  if (before_end_of_run != nullptr) before_end_of_run();
  _exit(static_cast<int>(scene::ErrorCode::system_failure));
}

pid_t parent_of(pid_t process) {
  std::ifstream stat(fmt::format("/proc/{}/stat", process));
  const std::string text(std::istreambuf_iterator<char>(stat), {});
  // The second field is a name in brackets, which may contain any character; state and parent follow it.
  const std::size_t name_end = text.rfind(')');
  if (name_end == std::string::npos || name_end + 4 > text.size()) return 0;
  return static_cast<pid_t>(std::atoi(text.c_str() + name_end + 4));
}

/// Returns the processes that may send SIGTERM to all ranks at once: the parent and, if the launcher started a script,
/// the launcher itself. The launcher puts the processes that it starts into a separate process group.
std::array<pid_t, 2> find_launchers() {
  const pid_t group = getpgrp();
  pid_t outside = getppid();
  while (outside > 1 && getpgid(outside) == group) outside = parent_of(outside);
  return {getppid(), outside};
}

}  // namespace

void answer_termination(Transport& transport, const std::string& program, const std::string& remedy,
                        void (*before_end)() noexcept) {
  remedy_of_run = remedy;
  before_end_of_run = before_end;
  line_of_run = fmt::format(
      "{}: the run was ended from outside or has lost a rank (the launcher reports which one); {}\n", program, remedy);
  speaks_for_the_lost = share_one_line(transport);
  launchers = find_launchers();
  struct sigaction action {};
  action.sa_sigaction = on_termination;
  action.sa_flags = SA_SIGINFO;
  sigaction(SIGTERM, &action, nullptr);
  sigaction(SIGALRM, &action, nullptr);
  prctl(PR_SET_PDEATHSIG, SIGTERM);
}

std::optional<scene::Error> ended_from_outside(int rank, int size) {
  if (!asked_to_end) return std::nullopt;
  return scene::Error(
      scene::ErrorCode::system_failure,
      fmt::format("the run was ended from outside (rank {} of {} got SIGTERM); {}", rank, size, remedy_of_run));
}

void expect_end() { is_ending = true; }

}  // namespace tessera::exchange
