// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>
#include <functional>
#include <memory>
#include <optional>

#include "exchange/heartbeats.hpp"
#include "exchange/transport.hpp"

namespace tessera::exchange {

/// Whether a launcher (mpirun, srun) started this process as a rank of a job; from the environment, without MPI.
bool launched_by_mpi();

/// This process's place in a caller's communicator, by its Fortran handle. Throws Error(bad_input) if MPI does not run.
struct MpiShape {
  int rank = 0, size = 1;
};
MpiShape mpi_shape(int fortran_handle);

/// Ranks that are processes: those of MPI's world, which this object then starts and ends, or of a communicator that a
/// caller has.
///
/// One thread of this object makes all MPI calls, so in the world MPI_THREAD_FUNNELED is enough; beside a caller that
/// speaks MPI itself it takes MPI_THREAD_MULTIPLE. It always takes what arrives: no send waits for the other side to
/// look, and a rank that waits sleeps instead of spinning. It looks for messages whenever it sends, 100 microseconds
/// after one came, and then ever less often, down to every 2 milliseconds; set_working(true) makes that every 2 to 5
/// milliseconds. Where all ranks have bells it
/// looks when they ring, unless it works, and else every 20 milliseconds.
///
/// Faults: a rank that fails tells rank 0, which decides on the first one it hears of and tells all. A rank that cannot
/// end in an orderly way within `patience` after that (it hangs in a read, or its peers are gone) speaks and
/// ends the process. The death of a process is the launcher's to notice: it ends the other ranks by SIGTERM. A process
/// that stands still is noticed by heartbeats (watch_stalls(), heartbeats.hpp); there are none while MPI starts and
/// ends.
class MpiTransport final : public Transport {
 public:
  using Speak = std::function<void(const scene::Error& error)>;

  /// What the transport asks of its process.
  struct Hooks {
    /// Tells the user of the run's error, from any thread: on rank 0 before any rank can end, because a launcher ends
    /// all ranks as soon as one ends with an error; on others as a last resort.
    Speak speak;
    /// Called once on every rank as soon as it knows of the error: from then on the launcher may end it.
    std::function<void()> on_fault;
    /// The error, if somebody wants this rank, of so many, to end. Looked at every few milliseconds; may be empty.
    std::function<std::optional<scene::Error>(int rank, int size)> asked_to_end;
  };

  /// Starts MPI. Throws Error(system_failure) if that fails.
  explicit MpiTransport(Hooks hooks, std::chrono::milliseconds patience = std::chrono::seconds(5));
  /// Over a duplicate of a caller's communicator, by its Fortran handle. Collective, and so is the destructor. Nothing
  /// of the process is touched: where the world's transport ends it, this one gives the run up and leaves what it
  /// has. Throws Error(bad_input) if MPI does not run or gives too little thread support.
  explicit MpiTransport(int fortran_handle, std::chrono::milliseconds patience = std::chrono::seconds(5));
  ~MpiTransport() override;

  /// Looks for stalled ranks from now on. Every rank calls this, with the same settings but for `say`.
  void watch_stalls(const StallSettings& settings);

  /// The end of every rank's part, after its last send and receive, after an error too: waits until all ranks are here
  /// and shuts MPI down. Returns the run's error if there is one.
  std::optional<scene::Error> finish();

  [[nodiscard]] int rank() const override;
  [[nodiscard]] int size() const override;
  using Transport::send;
  void send(int to, Channel channel, Bytes bytes, std::int32_t frame) override;
  using Transport::receive;
  std::optional<Message> receive(Channel channel, std::chrono::milliseconds timeout) override;
  void fail(const scene::Error& error) override;
  void check() const override;
  void set_working(bool working) override;
  void use_bells(const std::shared_ptr<Bells>& bells) override;
  void trace_to(scene::Trace* projecting, scene::Trace* compositing) override;
  [[nodiscard]] Traffic sent(Channel channel) const override;

 private:
  class Engine;
  std::unique_ptr<Engine> engine_;
};

}  // namespace tessera::exchange
