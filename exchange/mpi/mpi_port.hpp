// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <memory>
#include <optional>

#include "exchange/transport.hpp"
#include "scene/trace.hpp"

namespace tessera::exchange {

/// MPI as far as mpi_transport.cpp needs it: bytes with a tag to a rank, and those that have come. mpi_port.cpp alone
/// includes mpi.h; mpi_absent.cpp takes its place with TESSERA_MPI=OFF.
///
/// No member function waits. All but the constructor are called by one thread. MPI's errors come out as
/// Error(system_failure) in its own words.
class MpiPort {
 public:
  /// On a duplicate of a caller's communicator, by its Fortran handle: collective. Throws Error(bad_input) if MPI does
  /// not run or gives too little thread support. Without a handle on MPI's world, which start() starts.
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
  /// Whether some have not left.
  [[nodiscard]] bool is_sending() const;
  /// Calls `visit` with the receiver of each message that has not left.
  void for_each_receiver(const std::function<void(int rank)>& visit) const;

  /// Begins to receive what is there; without waiting, as a long message needs its sender's looks at MPI, too. Returns
  /// whether there was anything.
  bool take();
  struct Arrived {
    Message message;
    int tag;
  };
  /// What has arrived, one at a time: those of one rank in the order in which it sent them.
  std::optional<Arrived> next();
  [[nodiscard]] bool is_receiving() const;

  /// Ends MPI, or frees the duplicate, when all has left.
  void finish();
  /// Instead of finish(): MPI may still read and write these messages; they stay for as long as the process.
  void abandon();

 private:
  struct State;
  std::unique_ptr<State> state_;
  int rank_ = 0, size_ = 1;
};

}  // namespace tessera::exchange
