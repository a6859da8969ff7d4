// SPDX-License-Identifier: BSD-3-Clause
#include "exchange/attempt.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <exception>
#include <mutex>
#include <optional>

#include "exchange/message.hpp"

namespace tessera::exchange {
namespace {

constexpr auto kind = MessageKind::attempt_end;
/// Longest time until a thread that waits on one channel notices an end message that came on another channel.
constexpr std::chrono::milliseconds slice(50);

bool is_end(const Bytes& message) {
  MessageHeader header;
  if (message.size() < sizeof header) return false;
  std::memcpy(&header, message.data(), sizeof header);
  return header.magic == wire_magic && header.version == wire_version && header.kind == kind;
}

class AttemptTransport final : public Transport {
 public:
  explicit AttemptTransport(Transport& beneath) : beneath_(beneath), errors_(static_cast<std::size_t>(beneath.size())) {
    for (auto& channel : ends_) channel.resize(errors_.size(), false);
  }

  [[nodiscard]] int rank() const override { return beneath_.rank(); }
  [[nodiscard]] int size() const override { return beneath_.size(); }

  using Transport::send;
  void send(int to, Channel channel, Bytes bytes, std::int32_t frame) override {
    if (!failed_) beneath_.send(to, channel, std::move(bytes), frame);
  }

  using Transport::receive;
  std::optional<Message> receive(Channel channel, std::chrono::milliseconds timeout) override {
    for (auto left = timeout;; left -= slice) {
      check();
      auto message = beneath_.receive(channel, std::min(left, slice));
      if (message && is_end(message->bytes))
        take_end(channel, *message);
      else if (message)
        return message;
      if (left <= slice) {
        check();
        return std::nullopt;
      }
    }
  }

  void fail(const scene::Error& error) override {
    const std::lock_guard lock(mutex_);
    if (!own_error_) own_error_ = error;
    end_own_part();
    failed_ = true;
  }

  void check() const override {
    beneath_.check();
    if (!failed_) return;
    const std::lock_guard lock(mutex_);
    throw scene::Error(*first_error());
  }

  void set_working(bool working) override { beneath_.set_working(working); }
  void trace_to(scene::Trace* projecting, scene::Trace* compositing) override {
    beneath_.trace_to(projecting, compositing);
  }
  [[nodiscard]] Traffic sent(Channel channel) const override { return beneath_.sent(channel); }

  /// Ends this rank's part: waits for the end messages of all other ranks, and receives all remaining messages.
  void settle() {
    {
      const std::lock_guard lock(mutex_);
      end_own_part();
    }
    for (std::size_t c = 0; c < channel_count; ++c) {
      const auto channel = static_cast<Channel>(c);
      while (std::ranges::find(ends_[c], false) != ends_[c].end()) {
        const Message message = beneath_.receive(channel);
        if (is_end(message.bytes)) take_end(channel, message);
      }
    }
    leave_together();
    const std::lock_guard lock(mutex_);
    for (const auto& error : errors_)
      if (error) throw scene::Error(*error);
  }

 private:
  /// Ensures that no rank continues while another rank still waits for end messages: the waiting rank would discard
  /// messages of the continuing rank as leftovers. Every rank that has all end messages sends a second one to rank 0,
  /// and leaves when rank 0 answers. The channel is `agreement`: all its messages come from rank 0 or go to it, so that
  /// no message overtakes another.
  void leave_together() {
    const Bytes message = end_message();
    if (rank() != 0) {
      beneath_.send(0, Channel::agreement, message);
      while (!is_end(beneath_.receive(Channel::agreement).bytes)) {
      }
      return;
    }
    while (settled_ < size() - 1)
      if (const Message other = beneath_.receive(Channel::agreement); is_end(other.bytes))
        take_end(Channel::agreement, other);
    for (int to = 1; to < size(); ++to) beneath_.send(to, Channel::agreement, message);
  }

  [[nodiscard]] Bytes end_message() const {
    Bytes message = begin_message(kind);
    append(message, static_cast<std::uint8_t>(own_error_ ? own_error_->code() : scene::ErrorCode{}));
    append_text(message, own_error_ ? own_error_->what() : "");
    return message;
  }

  void end_own_part() {
    if (std::exchange(ended_, true)) return;
    const Bytes message = end_message();
    for (int to = 0; to < size(); ++to)
      for (std::size_t c = 0; c < channel_count; ++c) beneath_.send(to, static_cast<Channel>(c), message);
  }

  void take_end(Channel channel, const Message& message) {
    MessageReader reader(message.bytes, message.from, kind);
    const auto code = static_cast<scene::ErrorCode>(reader.take<std::uint8_t>());
    const std::string text(reader.take_text());
    reader.finish();
    const std::lock_guard lock(mutex_);
    const auto from = static_cast<std::size_t>(message.from);
    if (ends_[static_cast<std::size_t>(channel)][from]) {
      ++settled_;
      return;
    }
    ends_[static_cast<std::size_t>(channel)][from] = true;
    if (code == scene::ErrorCode{}) return;
    errors_[from] = scene::Error(code, text);
    failed_ = true;
  }

  [[nodiscard]] const scene::Error* first_error() const {
    for (const auto& error : errors_)
      if (error) return &*error;
    return &*own_error_;
  }

  Transport& beneath_;
  mutable std::mutex mutex_;
  std::atomic<bool> failed_ = false;
  bool ended_ = false;
  int settled_ = 0;  ///< on rank 0: the number of other ranks that have all end messages
  std::optional<scene::Error> own_error_;
  std::vector<std::optional<scene::Error>> errors_;  ///< one per rank
  /// For each channel, one flag per rank: whether the rank has ended on the channel.
  std::array<std::vector<bool>, channel_count> ends_;
};

}  // namespace

void attempt(Transport& beneath, const std::function<void(Transport&)>& work) {
  AttemptTransport transport(beneath);
  try {
    work(transport);
  } catch (...) {
    beneath.check();  // throws the run's own error
    transport.fail(error_of(std::current_exception()));
  }
  transport.settle();
}

}  // namespace tessera::exchange
