// SPDX-License-Identifier: BSD-3-Clause
#include "frame/ranks/stop_relay.hpp"

#include <algorithm>

#include "exchange/message.hpp"
#include "scene/start_thread.hpp"

namespace tessera::frame {
namespace {

/// A rank sends this number to itself when the run is over, so that its listener ends.
constexpr std::uint64_t end_of_run = 0;

exchange::Bytes number_bytes(std::uint64_t number) { return exchange::message_of(exchange::MessageKind::stop, number); }

}  // namespace

StopRelay::Run::Run(StopRelay& relay, const std::stop_token& asked) : relay_(relay) {
  ++relay_.run_;
  if (relay_.stopped_ >= relay_.run_) stop_.request_stop();
  if (relay_.transport_.size() > 1) listener_ = scene::start_thread([this] { listen(); });
  asked_.emplace(asked, [this] { stop(); });
}

StopRelay::Run::~Run() {
  asked_.reset();
  if (!listener_.joinable()) return;
  relay_.transport_.send(relay_.transport_.rank(), exchange::Channel::stop, number_bytes(end_of_run));
  listener_.join();
}

void StopRelay::Run::stop() {
  if (!stop_.request_stop()) return;  // the other ranks have been notified
  for (int rank = 0; rank < relay_.transport_.size(); ++rank)
    if (rank != relay_.transport_.rank())
      relay_.transport_.send(rank, exchange::Channel::stop, number_bytes(relay_.run_));
}

void StopRelay::Run::listen() {
  try {
    for (;;) {
      const exchange::Message message = relay_.transport_.receive(exchange::Channel::stop);
      const auto number = exchange::value_of<std::uint64_t>(message.bytes, message.from, exchange::MessageKind::stop);
      if (number == end_of_run) return;
      relay_.stopped_ = std::max(relay_.stopped_, number);
      if (number == relay_.run_) stop_.request_stop();
    }
  } catch (const scene::Error&) {
    stop_.request_stop();  // the run has failed; senders and receivers get its error
  }
}

}  // namespace tessera::frame
