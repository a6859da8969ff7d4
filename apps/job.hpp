#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string_view>

#include "exchange/transport.hpp"

namespace tessera::exchange {
class LoopbackNetwork;
class MpiTransport;
struct StallSettings;
}  // namespace tessera::exchange

namespace tessera::apps {

/// The ranks that run this command: those that a launcher started, or this process alone, without MPI.
class Job {
 public:
  /// `speak(error)` prints the error's line. Throws Error(system_failure) if MPI cannot start.
  explicit Job(std::function<void(const scene::Error&)> speak);
  ~Job();

  [[nodiscard]] exchange::Transport& transport();
  /// Looks for ranks that have stopped from now on. Every rank calls this.
  void watch_stalls(const exchange::StallSettings& settings);
  /// Rank 0, which speaks for all.
  [[nodiscard]] bool is_first() { return transport().rank() == 0; }

  /// The end of every rank's part. Returns the run's error, the same on all ranks, if there is one; one rank has
  /// spoken.
  std::optional<scene::Error> finish();

 private:
  std::function<void(const scene::Error&)> speak_;
  std::unique_ptr<exchange::LoopbackNetwork> alone_;
  std::unique_ptr<exchange::MpiTransport> mpi_;
};

/// Lets ranks that are ended from outside say so, in one line of all, and end with status 3. The launcher ends all
/// ranks at once, as it does when one has died: then the first that is ended on rank 0's machine speaks. A rank that
/// anybody else ends (SIGTERM) ends the run for all, see ended_from_outside(). A launcher that dies takes its ranks
/// with it. Collective; for jobs of several ranks (Linux).
void speak_when_ended(exchange::Transport& transport);

/// The run's error, once this rank got SIGTERM from somebody else than its launcher.
std::optional<scene::Error> ended_from_outside();

/// From now on a launcher that ends this rank only hurries it: other ranks may have ended already, with the status that
/// all will have.
void expect_end();

}  // namespace tessera::apps
