// SPDX-License-Identifier: BSD-3-Clause
#include "tessera/job.hpp"

#include <fmt/format.h>

#include <csignal>
#include <cstdio>
#include <memory>
#include <utility>

#include "api/communicator.hpp"
#include "api/same_files.hpp"
#include "exchange/attempt.hpp"
#include "exchange/bells.hpp"
#include "exchange/collectives.hpp"
#include "exchange/first_contact.hpp"
#include "exchange/instruction_sets.hpp"
#include "exchange/loopback_transport.hpp"
#include "exchange/mpi/mpi_transport.hpp"
#include "exchange/one_line.hpp"
#include "exchange/termination.hpp"
#include "system/unfinished.hpp"

namespace tessera {
inline namespace v0_1 {

struct Job::State {
  JobReporting reporting;
  std::unique_ptr<exchange::LoopbackNetwork> alone;
  std::unique_ptr<exchange::MpiTransport> mpi;

  exchange::Transport& transport() {
    if (mpi) return *mpi;
    return alone->rank(0);
  }

  /// Makes the first contact between ranks, before ranks wait for one another.
  void meet() {
    if (std::exchange(has_met, true)) return;
    exchange::make_first_contact(transport(), exchange::first_contact_patience(), reporting.arguments);
    if (transport().size() > 1) transport().use_bells(exchange::Bells::hung(transport()));
  }
  bool has_met = false;
};

Job::Job(JobReporting reporting)
    : state_(std::make_unique<State>(State{std::move(reporting), nullptr, nullptr, false})) {
  if (exchange::launched_by_mpi()) {
    // When the launcher dies, its sockets are closed. Ignoring SIGPIPE makes writes to them fail instead of killing the
    // rank.
    std::signal(SIGPIPE, SIG_IGN);
    state_->mpi = std::make_unique<exchange::MpiTransport>(
        exchange::MpiTransport::Hooks{state_->reporting.report, exchange::expect_end, exchange::ended_from_outside});
  } else {
    state_->alone = std::make_unique<exchange::LoopbackNetwork>(1);
  }
}

Job::~Job() = default;

int Job::rank() const { return state_->transport().rank(); }
int Job::size() const { return state_->transport().size(); }
Communicator Job::communicator() { return api::communicator_over(state_->transport()); }

void Job::answer_termination() {
  state_->meet();
  if (size() > 1)
    exchange::answer_termination(state_->transport(), state_->reporting.program, state_->reporting.remedy,
                                 system::abandon_in_handler);
}

void Job::watch_stalls(const StallSettings& settings) {
  if (state_->mpi) state_->mpi->watch_stalls(settings);
}

void Job::agree_instruction_sets() {
  state_->meet();
  if (size() > 1) exchange::agree_instruction_sets(state_->transport());
}

void Job::require_same_files() { api::require_same_files(state_->transport()); }

std::vector<std::byte> Job::broadcast(int root, std::vector<std::byte> bytes) {
  constexpr auto kind = exchange::MessageKind::of_job;
  exchange::Bytes message = exchange::begin_message(kind, bytes.size());
  exchange::append_list(message, bytes);
  message = exchange::broadcast(state_->transport(), root, std::move(message));
  exchange::MessageReader reader(message, root, kind);
  bytes = reader.take_list<std::byte>();
  reader.finish();
  return bytes;
}

void Job::attempt(const std::function<void(const Communicator&)>& work) {
  if (size() == 1) return work(communicator());
  exchange::attempt(state_->transport(),
                    [&](exchange::Transport& transport) { work(api::communicator_over(transport)); });
}

void Job::fail(const Error& error) { state_->transport().fail(error); }

std::optional<Error> Job::finish() {
  if (state_->mpi) {
    exchange::expect_end();
    return state_->mpi->finish();
  }
  try {
    state_->alone->rank(0).check();
    return std::nullopt;
  } catch (const Error& error) {
    state_->reporting.report(error);
    return error;
  }
}

void Job::print_once(const std::string& line) {
  if (!exchange::may_speak()) return;
  fmt::print(stderr, "{}\n", line);
  std::fflush(stderr);
}

}  // namespace v0_1
}  // namespace tessera
