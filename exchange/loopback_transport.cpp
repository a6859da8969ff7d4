// SPDX-License-Identifier: BSD-3-Clause
#include "exchange/loopback_transport.hpp"

#include <exception>
#include <thread>

#include "exchange/mailboxes.hpp"

namespace tessera::exchange {

class LoopbackNetwork::Rank final : public Transport {
 public:
  Rank(LoopbackNetwork& network, int rank) : network_(network), rank_(rank) {}

  [[nodiscard]] int rank() const override { return rank_; }
  [[nodiscard]] int size() const override { return network_.size(); }

  using Transport::send;
  void send(int to, Channel channel, Bytes bytes, std::int32_t /*frame*/) override {
    if (mailboxes_.failed()) return;
    if (to != rank_) sent_.add(channel, bytes.size());
    network_.ranks_.at(static_cast<std::size_t>(to))->mailboxes_.deliver(channel, {rank_, std::move(bytes)});
  }
  using Transport::receive;
  std::optional<Message> receive(Channel channel, std::chrono::milliseconds timeout) override {
    return mailboxes_.receive(channel, timeout);
  }
  void fail(const scene::Error& error) override {
    // Errors are set under one lock, so that two errors at the same time leave every rank with the same error.
    const std::lock_guard lock(network_.fault_);
    for (auto& rank : network_.ranks_) rank->mailboxes_.fail(error);
  }
  void trace_to(scene::Trace*, scene::Trace*) override {}  // no data is transferred
  void check() const override { mailboxes_.check(); }
  [[nodiscard]] Traffic sent(Channel channel) const override { return sent_.of(channel); }

 private:
  LoopbackNetwork& network_;
  int rank_;
  Mailboxes mailboxes_;
  TrafficCounters sent_;
};

LoopbackNetwork::LoopbackNetwork(int ranks) {
  for (int rank = 0; rank < ranks; ++rank) ranks_.push_back(std::make_unique<Rank>(*this, rank));
}
LoopbackNetwork::~LoopbackNetwork() = default;
int LoopbackNetwork::size() const { return static_cast<int>(ranks_.size()); }
Transport& LoopbackNetwork::rank(int rank) { return *ranks_.at(static_cast<std::size_t>(rank)); }

void run_ranks(int ranks, const std::function<void(Transport&)>& work) {
  LoopbackNetwork network(ranks);
  std::vector<std::thread> threads;
  threads.reserve(static_cast<std::size_t>(ranks));
  for (int rank = 0; rank < ranks; ++rank)
    threads.emplace_back([&, rank] {
      Transport& transport = network.rank(rank);
      try {
        work(transport);
      } catch (const scene::Error& error) {
        transport.fail(error);
      } catch (const std::exception& error) {
        transport.fail(scene::Error(scene::ErrorCode::system_failure, error.what()));
      }
    });
  for (auto& thread : threads) thread.join();
  network.rank(0).check();
}

}  // namespace tessera::exchange
