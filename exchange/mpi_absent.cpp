// Built in place of mpi_transport.cpp with TESSERA_MPI=OFF.
#include "exchange/mpi_transport.hpp"

namespace tessera::exchange {

bool launched_by_mpi() { return false; }

MpiShape mpi_shape(int) {
  throw scene::Error(scene::ErrorCode::system_failure, "MPI: this library was built without it (TESSERA_MPI=OFF)");
}

class MpiTransport::Engine {};

MpiTransport::MpiTransport(Hooks, std::chrono::milliseconds) {
  throw scene::Error(scene::ErrorCode::system_failure, "MPI: this program was built without it (TESSERA_MPI=OFF)");
}
MpiTransport::MpiTransport(int, std::chrono::milliseconds) : MpiTransport(Hooks{}, {}) {}
MpiTransport::~MpiTransport() = default;

std::optional<scene::Error> MpiTransport::finish() { return std::nullopt; }
int MpiTransport::rank() const { return 0; }
int MpiTransport::size() const { return 1; }
void MpiTransport::send(int, Channel, Bytes, std::int32_t) {}
std::optional<Message> MpiTransport::receive(Channel, std::chrono::milliseconds) { return std::nullopt; }
void MpiTransport::fail(const scene::Error&) {}
void MpiTransport::check() const {}
void MpiTransport::set_working(bool) {}
void MpiTransport::watch_stalls(const StallSettings&) {}
void MpiTransport::trace_to(scene::Trace*, scene::Trace*) {}
Transport::Traffic MpiTransport::sent(Channel) const { return {}; }

}  // namespace tessera::exchange
