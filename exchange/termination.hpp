// SPDX-License-Identifier: BSD-3-Clause
#pragma once

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

/// The run's error, once this rank, of so many, got SIGTERM from somebody else than its launcher.
std::optional<scene::Error> ended_from_outside(int rank, int size);

/// From now on a launcher that ends this rank only hurries it: other ranks may have ended already, with the status that
/// all will have.
void expect_end();

}  // namespace tessera::exchange
