#include "tessera/job.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <string_view>
#include <utility>

#include "exchange/attempt.hpp"
#include "exchange/bells.hpp"
#include "exchange/collectives.hpp"
#include "exchange/first_contact.hpp"
#include "exchange/instruction_sets.hpp"
#include "exchange/loopback_transport.hpp"
#include "exchange/mpi_transport.hpp"
#include "exchange/one_line.hpp"
#include "exchange/start_witness.hpp"
#include "exchange/termination.hpp"
#include "frame/communicator.hpp"
#include "io/unfinished.hpp"

namespace tessera {

namespace {

/// A library that gives up: Open MPI's reader of its own words, where memory has run out, which leaves nobody a line.
extern "C" void on_abort(int /*signal*/) {
  if (exchange::may_speak()) {
    constexpr std::string_view line =
        "tessera: a library gave up, most likely because memory ran out; use a larger machine, fewer ranks or threads, "
        "or a part of the data\n";
    [[maybe_unused]] const auto written = ::write(STDERR_FILENO, line.data(), line.size());
    exchange::hold_one_line();
  }
  std::_Exit(static_cast<int>(ErrorCode::system_failure));
}

}  // namespace

struct Job::State {
  JobVoice voice;
  std::unique_ptr<exchange::LoopbackNetwork> alone;
  std::unique_ptr<exchange::MpiTransport> mpi;

  exchange::Transport& transport() {
    if (mpi) return *mpi;
    return alone->rank(0);
  }

  /// Before ranks first wait for one another.
  void meet() {
    if (std::exchange(has_met, true)) return;
    exchange::make_first_contact(transport(), exchange::first_contact_patience(), voice.arguments);
    if (transport().size() > 1) transport().use_bells(exchange::Bells::hung(transport()));
  }
  bool has_met = false;
};

Job::Job(JobVoice voice) : state_(std::make_unique<State>(State{std::move(voice), nullptr, nullptr, false})) {
  if (exchange::launched_by_mpi()) {
    // A launcher that goes while MPI starts closes its sockets: an error of a write, not the death of a rank by a
    // signal of which nobody says a word.
    std::signal(SIGPIPE, SIG_IGN);
    std::signal(SIGABRT, on_abort);  // which Open MPI leaves in place
    exchange::name_one_line();
    const exchange::StartWitness witness(state_->voice.program);
    const exchange::TerminationWhileStarting remembered(state_->voice.remedy);
    const auto& stalls = state_->voice.stalls;
    const std::chrono::milliseconds patience =
        stalls && stalls->ends_run ? stalls->timeout + std::chrono::seconds(5) : std::chrono::seconds(0);
    state_->mpi = std::make_unique<exchange::MpiTransport>(exchange::MpiTransport::Hooks{
        state_->voice.speak, exchange::expect_end, exchange::ended_from_outside, patience,
        [&](const Error& error) { witness.leave_words(fmt::format("{}: {}\n", state_->voice.program, error.what())); },
        exchange::go_on_if_stopped});
    if (stalls) state_->mpi->watch_stalls(*stalls);
  } else {
    state_->alone = std::make_unique<exchange::LoopbackNetwork>(1);
  }
}

Job::~Job() = default;

int Job::rank() const { return state_->transport().rank(); }
int Job::size() const { return state_->transport().size(); }
Communicator Job::communicator() { return frame::communicator_over(state_->transport()); }

void Job::answer_termination() {
  state_->meet();
  if (size() > 1)
    exchange::answer_termination(state_->transport(), state_->voice.program, state_->voice.remedy,
                                 io::abandon_in_handler);
}

void Job::watch_stalls(const StallSettings& settings) {
  if (state_->mpi) state_->mpi->watch_stalls(settings);
}

void Job::agree_instruction_sets() {
  state_->meet();
  if (size() > 1) exchange::agree_instruction_sets(state_->transport());
}

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
                    [&](exchange::Transport& transport) { work(frame::communicator_over(transport)); });
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
    state_->voice.speak(error);
    return error;
  }
}

void Job::say_once(const std::string& line) {
  if (!exchange::may_speak()) return;
  fmt::print(stderr, "{}\n", line);
  std::fflush(stderr);
  exchange::hold_one_line();
}

}  // namespace tessera
