#include "compositor/group_transport.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace tessera::compositor {

GroupTransport::GroupTransport(Transport& whole, std::vector<int> ranks)
    : whole_(whole), ranks_(std::move(ranks)), rank_(member(whole.rank())) {}

void GroupTransport::send(int to, Channel channel, Bytes bytes, std::int32_t frame) {
  whole_.send(ranks_.at(static_cast<std::size_t>(to)), channel, std::move(bytes), frame);
}

std::optional<Message> GroupTransport::receive(Channel channel, std::chrono::milliseconds timeout) {
  auto message = whole_.receive(channel, timeout);
  if (message) message->from = member(message->from);
  return message;
}

int GroupTransport::member(int rank_of_whole) const {
  const auto found = std::find(ranks_.begin(), ranks_.end(), rank_of_whole);
  if (found == ranks_.end())
    throw scene::Error(scene::ExitCode::system_failure,
                       fmt::format("rank {} is not of the group that talks here; please report", rank_of_whole));
  return static_cast<int>(found - ranks_.begin());
}

}  // namespace tessera::compositor
