// SPDX-License-Identifier: BSD-3-Clause
// Built instead of mpi_port.cpp with TESSERA_MPI=OFF: no process counts as launched by MPI, and opening a port fails.
#include "exchange/mpi/mpi_port.hpp"
#include "exchange/mpi/mpi_transport.hpp"

namespace tessera::exchange {

bool launched_by_mpi() { return false; }

MpiShape mpi_shape(int) {
  throw scene::Error(scene::ErrorCode::system_failure, "MPI: this library was built without it (TESSERA_MPI=OFF)");
}

struct MpiPort::State {};

MpiPort::MpiPort(std::optional<int>) {
  throw scene::Error(scene::ErrorCode::system_failure, "MPI: this program was built without it (TESSERA_MPI=OFF)");
}
MpiPort::~MpiPort() = default;
void MpiPort::start() {}
void MpiPort::send(int, int, Bytes) {}  // NOLINT(performance-unnecessary-value-param): with MPI, bytes are stored
void MpiPort::complete() {}
bool MpiPort::is_sending() const { return false; }
void MpiPort::for_each_receiver(const std::function<void(int)>&) const {}
bool MpiPort::take() { return false; }
std::optional<MpiPort::Arrived> MpiPort::next() { return std::nullopt; }
bool MpiPort::is_receiving() const { return false; }
void MpiPort::finish() {}
void MpiPort::abandon() {}

}  // namespace tessera::exchange
