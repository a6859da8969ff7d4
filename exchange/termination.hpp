// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>

#include "exchange/transport.hpp"

/// The behaviour of a rank that is terminated from outside: see tessera::Job::answer_termination(). Linux.
namespace tessera::exchange {

/// Installs handlers of SIGTERM and SIGALRM for the lifetime of the process. `program` and `remedy` as in JobReporting;
/// `before_end` is called in the handler before the process ends, and must be safe in signal handlers. Collective; for
/// jobs of several ranks.
void answer_termination(Transport& transport, const std::string& program, const std::string& remedy,
                        void (*before_end)() noexcept);

/// The run's error once rank `rank` of `size`, this one, has received SIGTERM from a process other than its launcher.
std::optional<scene::Error> ended_from_outside(int rank, int size);

/// From now on, SIGTERM only limits the time that this rank takes to end to one second: other ranks may have ended
/// already, and this one is to end with the same status.
void expect_end();

}  // namespace tessera::exchange
