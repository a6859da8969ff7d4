// SPDX-License-Identifier: BSD-3-Clause
#include "api/communicator.hpp"

#include "exchange/bells.hpp"
#include "exchange/loopback_transport.hpp"
#include "exchange/mpi/mpi_transport.hpp"

namespace tessera {
inline namespace v0_1 {
namespace {

std::shared_ptr<exchange::Transport> alone() {
  auto network = std::make_shared<exchange::LoopbackNetwork>(1);
  exchange::Transport& transport = network->rank(0);
  return {std::move(network), &transport};
}

}  // namespace

Communicator::Communicator() : state_(std::make_shared<const State>(State{0, 1, alone})) {}

Communicator Communicator::of_handle(int fortran_handle) {
  const exchange::MpiShape shape = exchange::mpi_shape(fortran_handle);
  if (shape.size == 1) return {};
  return Communicator(std::make_shared<const State>(
      State{shape.rank, shape.size, [fortran_handle]() -> std::shared_ptr<exchange::Transport> {
              auto transport = std::make_shared<exchange::MpiTransport>(fortran_handle);
              transport->use_bells(exchange::Bells::hung(*transport));
              return transport;
            }}));
}

int Communicator::rank() const { return state_->rank; }
int Communicator::size() const { return state_->size; }

void run_ranks(int ranks, const std::function<void(const Communicator&)>& work) {
  exchange::run_ranks(ranks, [&](exchange::Transport& transport) { work(api::communicator_over(transport)); });
}

}  // namespace v0_1

namespace api {

Communicator communicator_over(exchange::Transport& transport) {
  return StateAccess::make(std::make_shared<const Communicator::State>(Communicator::State{
      transport.rank(), transport.size(),
      [&transport] { return std::shared_ptr<exchange::Transport>(std::shared_ptr<void>(), &transport); }}));
}

}  // namespace api
}  // namespace tessera
