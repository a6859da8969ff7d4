// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <memory>
#include <optional>

#include "exchange/transport.hpp"
#include "scene/trace.hpp"

namespace tessera::exchange {

/// The subset of MPI that mpi_transport.cpp needs: bytes with a tag to a rank, and those that have arrived. Only
/// mpi_port.cpp includes mpi.h; mpi_absent.cpp replaces it with TESSERA_MPI=OFF.
///
/// Only start() and finish() wait. All but the constructor are called by one thread. MPI's errors become
/// Error(system_failure) with its own text.
class MpiPort {
 public:
  /// On a duplicate of a caller's communicator, given by its Fortran handle: collective. Throws Error(bad_input) if MPI
  /// is not running or provides too little thread support. Without a handle: on MPI's world, which start() starts.
  explicit MpiPort(std::optional<int> fortran_handle);
  ~MpiPort();
  MpiPort(const MpiPort&) = delete;
  MpiPort& operator=(const MpiPort&) = delete;

  void start();
  [[nodiscard]] int rank() const { return rank_; }
  [[nodiscard]] int size() const { return size_; }

  void send(int to, int tag, Bytes bytes);
  /// Frees messages that have left.
  void complete();
  /// Whether some messages have not left.
  [[nodiscard]] bool is_sending() const;
  /// Calls `visit` with the receiver of each message that has not left.
  void for_each_receiver(const std::function<void(int rank)>& visit) const;

  /// Begins to receive the messages that are there. Does not wait, because a long message also needs its sender to poll
  /// MPI. Returns whether there were any.
  bool take();
  struct Arrived {
    Message message;
    int tag;
  };
  /// The messages that have arrived, one at a time: those of one rank in the order in which it sent them.
  std::optional<Arrived> next();
  [[nodiscard]] bool is_receiving() const;

  /// Waits until all messages have left, then ends MPI or frees the duplicate.
  void finish();
  /// Instead of finish(): MPI may still read and write these messages, so they stay allocated until the process ends.
  void abandon();

 private:
  struct State;
  std::unique_ptr<State> state_;
  int rank_ = 0, size_ = 1;
};

}  // namespace tessera::exchange
