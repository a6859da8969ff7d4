#include "apps/job.hpp"

#include <csignal>

#include "apps/one_line.hpp"
#include "apps/start_witness.hpp"
#include "exchange/loopback_transport.hpp"
#include "exchange/mpi_transport.hpp"

namespace tessera::apps {

Job::Job(std::function<void(const scene::Error&)> speak) : speak_(std::move(speak)) {
  if (exchange::launched_by_mpi()) {
    // A launcher that goes while MPI starts closes its sockets: an error of a write, not the death of a rank by a
    // signal of which nobody says a word.
    std::signal(SIGPIPE, SIG_IGN);
    name_one_line();
    const StartWitness witness;
    mpi_ =
        std::make_unique<exchange::MpiTransport>(exchange::MpiTransport::Hooks{speak_, expect_end, ended_from_outside});
  } else {
    alone_ = std::make_unique<exchange::LoopbackNetwork>(1);
  }
}

Job::~Job() = default;

exchange::Transport& Job::transport() {
  if (mpi_) return *mpi_;
  return alone_->rank(0);
}

void Job::watch_stalls(const exchange::StallSettings& settings) {
  if (mpi_) mpi_->watch_stalls(settings);
}

std::optional<scene::Error> Job::finish() {
  if (mpi_) {
    expect_end();
    return mpi_->finish();
  }
  try {
    alone_->rank(0).check();
    return std::nullopt;
  } catch (const scene::Error& error) {
    speak_(error);
    return error;
  }
}

}  // namespace tessera::apps
