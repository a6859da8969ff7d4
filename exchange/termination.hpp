#pragma once

#include <chrono>
#include <csignal>
#include <optional>
#include <string>

#include "exchange/transport.hpp"

/// What a rank does that is ended from outside: tessera::Job::answer_termination() says it. Linux.
namespace tessera::exchange {

/// Installs handlers of SIGTERM and SIGALRM for as long as the process lives. `program` and `remedy` as JobVoice has
/// them; `before_end` is called in the handler, before the process ends in it, and does what a handler may. Collective;
/// for jobs of several ranks.
void answer_termination(Transport& transport, const std::string& program, const std::string& remedy,
                        void (*before_end)() noexcept);

/// While MPI starts: SIGTERM from somebody else than the launcher is remembered. A rank that dies in MPI's start can
/// leave Open MPI's launcher waiting for ever (4.1.4: PMIx's server locks itself out as it ends). A second one ends the
/// process.
class TerminationWhileStarting {
 public:
  explicit TerminationWhileStarting(const std::string& remedy);
  ~TerminationWhileStarting();
  TerminationWhileStarting(const TerminationWhileStarting&) = delete;
  TerminationWhileStarting& operator=(const TerminationWhileStarting&) = delete;

 private:
  struct sigaction before_ {};
};

/// The run's error, once this rank, of so many, got SIGTERM from somebody else than its launcher.
std::optional<scene::Error> ended_from_outside(int rank, int size);

/// This process goes on if it is found stopped `every` so long from now on: its part is over but for its exit, which
/// the launcher waits for, and of its own ranks none may be left that could miss it.
void go_on_if_stopped(std::chrono::milliseconds every);

/// From now on a launcher that ends this rank only hurries it: other ranks may have ended already, with the status that
/// all will have.
void expect_end();

}  // namespace tessera::exchange
