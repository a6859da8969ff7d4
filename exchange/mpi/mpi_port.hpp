// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <memory>
#include <optional>

#include "exchange/transport.hpp"
#include "scene/trace.hpp"

namespace tessera::exchange {

/// The subset of MPI that mpi_transport.cpp needs: it sends bytes with a tag to a rank, and receives bytes that have
/// arrived. Only mpi_port.cpp includes mpi.h; with TESSERA_MPI=OFF, mpi_absent.cpp replaces it.
///
/// Only start() and finish() block. All functions but the constructor must be called by one thread. MPI's errors are
/// thrown as Error(system_failure) with the text of MPI.
class MpiPort {
 public:
  /// With a handle, uses a duplicate of a caller's communicator, given by its Fortran handle; this is collective, and
  /// throws Error(bad_input) if MPI is not running or provides too little thread support. Without a handle, uses MPI's
  /// world, which start() initializes.
  explicit MpiPort(std::optional<int> fortran_handle);
  ~MpiPort();
  MpiPort(const MpiPort&) = delete;
  MpiPort& operator=(const MpiPort&) = delete;

  void start();
  [[nodiscard]] int rank() const { return rank_; }
  [[nodiscard]] int size() const { return size_; }

  void send(int to, int tag, Bytes bytes);
  /// Frees messages that have been sent completely.
  void complete();
  /// Whether some messages have not been sent completely.
  [[nodiscard]] bool is_sending() const;
  /// Calls `visit` with the receiver of each message that has not been sent completely.
  void for_each_receiver(const std::function<void(int rank)>& visit) const;

  /// Begins to receive the messages that MPI announces. Does not wait for them, because a long message also needs its
  /// sender to poll MPI. Returns whether there were any messages.
  bool take();
  struct Arrived {
    Message message;
    int tag;
  };
  /// Returns the next message that has arrived, if any. Messages of one rank come in the order in which that rank sent
  /// them.
  std::optional<Arrived> next();
  [[nodiscard]] bool is_receiving() const;

  /// Waits until all messages have been sent, then ends MPI or frees the duplicate of the communicator.
  void finish();
  /// Called instead of finish(). MPI may still read and write pending messages, so they stay allocated until the
  /// process ends.
  void abandon();

 private:
  struct State;
  std::unique_ptr<State> state_;
  int rank_ = 0, size_ = 1;
};

}  // namespace tessera::exchange
