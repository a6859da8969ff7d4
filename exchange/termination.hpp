// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>

#include "exchange/transport.hpp"

/// The behaviour of a rank that is terminated from outside: see tessera::Job::answer_termination(). Linux.
namespace tessera::exchange {

/// Installs handlers of SIGTERM and SIGALRM for the lifetime of the process. `program` and `remedy` are those of
/// JobReporting. A handler calls `before_end` before the process ends; `before_end` must be safe in signal handlers.
/// Collective; for jobs of several ranks.
void answer_termination(Transport& transport, const std::string& program, const std::string& remedy,
                        void (*before_end)() noexcept);

/// Returns the run's error if this rank, number `rank` of `size`, has received SIGTERM from a process other than its
/// launcher.
std::optional<scene::Error> ended_from_outside(int rank, int size);

/// After this call, SIGTERM no longer ends the rank, but limits the time until the rank ends to one second: other ranks
/// may have ended already, and this rank must end with the same status.
void expect_end();

}  // namespace tessera::exchange
