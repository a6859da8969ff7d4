#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string_view>

#include "compositor/transport.hpp"

namespace tessera::compositor {
class LoopbackNetwork;
class MpiTransport;
}  // namespace tessera::compositor

namespace tessera::apps {

/// The ranks that run this command: those that a launcher started, or this process alone, without MPI.
class Job {
 public:
  /// `speak(error)` prints the error's line. Throws Error(system_failure) if MPI cannot start.
  explicit Job(std::function<void(const scene::Error&)> speak);
  ~Job();

  [[nodiscard]] compositor::Transport& transport();
  /// Rank 0, which speaks for all.
  [[nodiscard]] bool is_first() { return transport().rank() == 0; }

  /// The end of every rank's part. Returns the run's error, the same on all ranks, if there is one; one rank has
  /// spoken.
  std::optional<scene::Error> finish();

 private:
  std::function<void(const scene::Error&)> speak_;
  std::unique_ptr<compositor::LoopbackNetwork> alone_;
  std::unique_ptr<compositor::MpiTransport> mpi_;
};

/// Lets a rank that its launcher ends from outside, as it does when another rank has died, say so: the lowest rank that
/// is left on its machine writes one line, and all end with status 3. A launcher that dies takes its ranks with it
/// (Linux). Collective; for jobs of several ranks.
void speak_when_ended(compositor::Transport& transport);

/// From now on a launcher that ends this rank only hurries it: other ranks may have ended already, with the status that
/// all will have.
void expect_end();

}  // namespace tessera::apps
