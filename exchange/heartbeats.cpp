// SPDX-License-Identifier: BSD-3-Clause
#include "exchange/heartbeats.hpp"

#include <fmt/format.h>

#include <numeric>
#include <utility>

#include "exchange/message.hpp"

namespace tessera::exchange {
namespace {

std::vector<int> watched_by(int rank, int size) {
  if (rank != 0) return {0};
  std::vector<int> others(static_cast<std::size_t>(size - 1));
  std::iota(others.begin(), others.end(), 1);
  return others;
}

Bytes beat(const std::string& name) {
  Bytes message = begin_message(MessageKind::alive);
  append_text(message, name);
  return message;
}

double seconds(StallWatch::Clock::duration time) { return std::chrono::duration<double>(time).count(); }

}  // namespace

Heartbeats::Heartbeats(int rank, int size, StallSettings settings, std::string name, Clock::time_point now)
    : rank_(rank),
      size_(size),
      settings_(std::move(settings)),
      watch_(watched_by(rank, size), settings_.timeout + rank * std::chrono::milliseconds(250), now),
      names_(static_cast<std::size_t>(size)),
      interval_(settings_.timeout / 8),
      next_beat_(now) {
  names_[static_cast<std::size_t>(rank)] = std::move(name);
}

std::vector<Heartbeats::Outgoing> Heartbeats::turn(Clock::time_point now) {
  std::vector<Outgoing> messages;
  if (now >= next_beat_) {
    next_beat_ = now + interval_;
    const Bytes own = beat(names_[static_cast<std::size_t>(rank_)]);
    for (const int to : watched_by(rank_, size_)) messages.push_back({to, own});
  }
  for (const StallWatch::Notice& silence : watch_.look(now)) notice(silence, messages);
  return messages;
}

void Heartbeats::take(int from, const Bytes& bytes) {
  MessageReader reader(bytes, from);
  if (reader.kind() == MessageKind::silent) return watch_.told(0);
  if (reader.kind() != MessageKind::alive) reader.refuse_kind();
  watch_.heard(from);
  names_[static_cast<std::size_t>(from)] = reader.take_text();
}

std::string Heartbeats::name_of(int rank) const {
  const std::string& name = names_[static_cast<std::size_t>(rank)];
  return fmt::format("rank {} of {}{}", rank, size_, name.empty() ? "" : " (" + name + ")");
}

void Heartbeats::notice(const StallWatch::Notice& notice, std::vector<Outgoing>& messages) {
  const std::string name = name_of(notice.rank);
  if (notice.back) {
    if (settings_.report) settings_.report(fmt::format("{} is back after {:.3g} s", name, seconds(notice.silent)));
    return;
  }
  if (rank_ != 0)
    for (int other = 1; other < size_; ++other)
      if (other != rank_) messages.push_back({other, begin_message(MessageKind::silent)});
  if (settings_.ends_run) {
    if (lost_) return;
    lost_ = {notice.rank,
             {scene::ErrorCode::system_failure,
              fmt::format("{} has been silent for {:.3g} s: its process is stopped or its machine hangs; finished "
                          "images are kept, and the same command with `resume` continues from there",
                          name, seconds(notice.silent))}};
    return;
  }
  if (settings_.report)
    settings_.report(
        fmt::format("{} has been silent for {:.3g} s: its process is stopped or its machine hangs; waiting "
                    "for it (`on_stall` abort ends the run)",
                    name, seconds(notice.silent)));
}

}  // namespace tessera::exchange
