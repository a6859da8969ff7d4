// SPDX-License-Identifier: BSD-3-Clause
#include "apps/interruption.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <string>
#include <thread>

#include "apps/render/progress.hpp"
#include "tessera/job.hpp"
#include "tessera/program/output_file.hpp"

namespace tessera::apps {
namespace {

/// A pipe through which the signal handler reports the signal to a thread. The thread may call functions that a signal
/// handler must not call.
std::array<int, 2> signal_pipe{-1, -1};
std::atomic<int> ending = 0;  ///< the number of the first signal

extern "C" void on_interruption(int signal) {
  const int before = errno;
  int none = 0;
  // A second signal ends the process at once.
  if (!ending.compare_exchange_strong(none, signal)) ::_exit(128 + signal);
  const auto number = static_cast<char>(signal);
  [[maybe_unused]] const ssize_t written = ::write(signal_pipe[1], &number, 1);
  errno = before;
}

[[noreturn]] void end_by(int signal) {
  StatusLine::end_all();
  abandon_outputs();
  Job::print_once(fmt::format("tessera: ended by {}; no incomplete output files are left", signal == SIGINT ? "Ctrl-C"
                                                                                           : signal == SIGTERM
                                                                                               ? "SIGTERM"
                                                                                               : "SIGHUP"));
  std::signal(signal, SIG_DFL);
  ::kill(::getpid(), signal);
  for (;;) ::pause();
}

void wait_for_interruption() {
  char signal = 0;
  ssize_t got = 0;
  while ((got = ::read(signal_pipe[0], &signal, 1)) < 0 && errno == EINTR) {
  }
  if (got == 1) end_by(signal);
}

}  // namespace

void answer_interruption() {
  if (::pipe2(signal_pipe.data(), O_CLOEXEC) != 0) return;  // without the pipe, signals end the process as usual
  try {
    std::thread(wait_for_interruption).detach();
  } catch (const std::exception&) {
    return;
  }
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
    struct sigaction present {};
    if (::sigaction(signal, nullptr, &present) != 0 || present.sa_handler == SIG_IGN) continue;
    struct sigaction action {};
    action.sa_handler = on_interruption;
    action.sa_flags = SA_RESTART;
    ::sigaction(signal, &action, nullptr);
  }
}

void yield_to_interruption() {
  while (ending != 0) ::pause();
}

}  // namespace tessera::apps
