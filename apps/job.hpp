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
  /// `last_words(error)` prints the error's line: where a rank must end the process because its peers do not answer.
  /// Throws Error(system_failure) if MPI cannot start.
  explicit Job(const std::function<void(const scene::Error&)>& last_words);
  ~Job();

  [[nodiscard]] compositor::Transport& transport();
  /// Rank 0, which speaks for all.
  [[nodiscard]] bool is_first() { return transport().rank() == 0; }

  /// The end of every rank's part. Returns the run's error, the same on all ranks, if there is one.
  std::optional<scene::Error> finish();

 private:
  std::unique_ptr<compositor::LoopbackNetwork> alone_;
  std::unique_ptr<compositor::MpiTransport> mpi_;
};

/// Lets a rank that its launcher ends from outside, as it does when another rank has died, say so: the lowest rank that
/// is left on its machine writes one line, and all end with status 3. A launcher that dies takes its ranks with it
/// (Linux). Collective; for jobs of several ranks.
void speak_when_ended(compositor::Transport& transport);

}  // namespace tessera::apps
