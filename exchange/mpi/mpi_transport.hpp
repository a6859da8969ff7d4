// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>
#include <functional>
#include <memory>
#include <optional>

#include "exchange/heartbeats.hpp"
#include "exchange/transport.hpp"

namespace tessera::exchange {

/// Whether a launcher (mpirun, srun) started this process as a rank of a job. Determined from the environment, without
/// calling MPI.
bool launched_by_mpi();

/// This process's rank in a caller's communicator, given by its Fortran handle. Throws Error(bad_input) if MPI is not
/// running.
struct MpiShape {
  int rank = 0, size = 1;
};
MpiShape mpi_shape(int fortran_handle);

/// Ranks that are processes: those of MPI's world, which this object starts and ends, or those of a caller's
/// communicator.
///
/// One thread of this object makes all MPI calls. MPI_THREAD_FUNNELED is therefore enough in MPI's world; if a caller
/// uses MPI itself, MPI_THREAD_MULTIPLE is needed. The thread receives messages at any time, so that no send waits for
/// the receiver to poll, and a rank that waits sleeps instead of spinning. The thread polls for messages whenever it
/// sends. It also polls 100 microseconds after a message came; while no further message comes, the pause between two
/// polls doubles up to 2 milliseconds. After set_working(true), pauses are 2 to 5 milliseconds. Unless the rank is
/// working, the thread also polls when its bell rings; if all ranks have bells, pauses are then up to 20 milliseconds.
///
/// Errors: a rank that fails reports its error to rank 0. Rank 0 chooses the first error that it receives and reports
/// it to all ranks. After that, a rank may be unable to end in an orderly way, because it hangs in a read or the other
/// ranks are gone. After `patience`, it prints the error and ends the process. The launcher notices when a process
/// dies, and ends the other ranks by SIGTERM. Heartbeats (watch_stalls(), heartbeats.hpp) detect a process that has
/// stopped, but not while MPI starts and ends.
class MpiTransport final : public Transport {
 public:
  using Speak = std::function<void(const scene::Error& error)>;

  /// Functions that connect the transport to its process.
  struct Hooks {
    /// Reports the run's error to the user; may be called from any thread. Rank 0 calls it before any rank can end,
    /// because a launcher ends all ranks as soon as one ends with an error; other ranks call it as a last resort.
    Speak speak;
    /// Called once on every rank as soon as the rank has the run's error: from then on, the launcher may end the rank.
    std::function<void()> on_fault;
    /// Returns an error if this rank, number `rank` of `size`, has been asked to end. Called every few milliseconds;
    /// may be empty.
    std::function<std::optional<scene::Error>(int rank, int size)> asked_to_end;
  };

  /// Starts MPI. Throws Error(system_failure) if that fails.
  explicit MpiTransport(Hooks hooks, std::chrono::milliseconds patience = std::chrono::seconds(5));
  /// Uses a duplicate of a caller's communicator, given by its Fortran handle. Collective, and so is the destructor.
  /// This transport never ends the process: instead, it gives up the run and abandons its messages. Throws
  /// Error(bad_input) if MPI is not running or provides too little thread support.
  explicit MpiTransport(int fortran_handle, std::chrono::milliseconds patience = std::chrono::seconds(5));
  ~MpiTransport() override;

  /// Watches for stalled ranks from now on. Every rank must call this, with the same settings except for `say`.
  void watch_stalls(const StallSettings& settings);

  /// Ends this rank's part. Every rank must call this after its last send and receive, also after an error. Waits until
  /// all ranks have called it, and shuts MPI down. Returns the run's error if there is one.
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
