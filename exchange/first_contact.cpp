// SPDX-License-Identifier: BSD-3-Clause
#include "exchange/first_contact.hpp"

#include <fmt/format.h>
#include <sys/resource.h>

#include <algorithm>
#include <string_view>

#include "exchange/message.hpp"

namespace tessera::exchange {
namespace {

using Clock = std::chrono::steady_clock;

rlim_t address_space() {
  rlimit space{};
  return getrlimit(RLIMIT_AS, &space) == 0 ? space.rlim_cur : RLIM_INFINITY;
}

/// Joins the words, each followed by a zero byte, which no argument contains.
std::string joined(const std::vector<std::string>& words) {
  std::string all;
  for (const std::string& word : words) all.append(word).push_back('\0');
  return all;
}

std::vector<std::string_view> split(std::string_view all) {
  std::vector<std::string_view> words;
  for (std::size_t end = 0; (end = all.find('\0')) != std::string_view::npos; all.remove_prefix(end + 1))
    words.push_back(all.substr(0, end));
  return words;
}

/// Returns the error for the first argument in which two ranks differ.
scene::Error differ(int rank, int size, std::string_view own, std::string_view other) {
  const auto ours = split(own), theirs = split(other);
  const auto at = static_cast<std::size_t>(std::mismatch(ours.begin(), ours.end(), theirs.begin(), theirs.end()).first -
                                           ours.begin());
  const auto word = [&](const std::vector<std::string_view>& words) {
    return at < words.size() ? fmt::format("'{}'", words[at]) : "nothing";
  };
  return scene::bad_input(fmt::format(
      "argument {}: rank {} of {} was given {} where the first rank was given {}; give all ranks the same arguments",
      at + 1, rank, size, word(theirs), word(ours)));
}

class Contact {
 public:
  Contact(Transport& transport, std::chrono::milliseconds patience, const std::vector<std::string>& arguments)
      : transport_(transport), patience_(patience), end_(Clock::now() + patience), arguments_(joined(arguments)) {}

  /// On rank 0, receives one message from each other rank; on other ranks, one from rank 0.
  void hear() {
    for (int missing = transport_.rank() == 0 ? transport_.size() - 1 : 1; missing > 0;)
      if (const auto message = transport_.receive(Channel::agreement, std::chrono::milliseconds(100))) {
        compare(*message);
        --missing;
      } else if (patience_.count() > 0 && Clock::now() > end_) {
        throw scene::Error(
            scene::ErrorCode::system_failure,
            fmt::format("MPI: rank {} of {} received nothing from {} in {} seconds after the start; {}",
                        transport_.rank(), transport_.size(), transport_.rank() == 0 ? "another rank" : "the first",
                        std::chrono::ceil<std::chrono::seconds>(patience_).count(), memory_remedy()));
      }
  }

  void say() {
    const int from = transport_.rank() == 0 ? 1 : 0, to = transport_.rank() == 0 ? transport_.size() : 1;
    Bytes message = begin_message(MessageKind::arguments);
    append_list(message, arguments_);
    for (int rank = from; rank < to; ++rank) transport_.send(rank, Channel::agreement, message);
  }

 private:
  void compare(const Message& message) const {
    MessageReader reader(message.bytes, message.from, MessageKind::arguments);
    const std::vector<char> list = reader.take_list<char>();
    reader.finish();
    const std::string_view other(list.data(), list.size());
    if (transport_.rank() == 0 && other != arguments_) throw differ(message.from, transport_.size(), arguments_, other);
  }

  Transport& transport_;
  std::chrono::milliseconds patience_;
  Clock::time_point end_;
  std::string arguments_;
};

}  // namespace

std::string memory_remedy() {
  const rlim_t space = address_space();
  if (space == RLIM_INFINITY) return "see the settings of MPI and of this machine";
  return fmt::format("a rank may use {} MiB of address space (ulimit -v), raise that limit", space >> 20);
}

void make_first_contact(Transport& transport, std::chrono::milliseconds patience,
                        const std::vector<std::string>& arguments) {
  if (transport.size() == 1) return;
  Contact contact(transport, patience, arguments);
  // Twice, so that rank 0 also knows that its message arrived: a rank that continued alone would wait without a time
  // limit.
  for (int round = 0; round < 2; ++round)
    if (transport.rank() == 0) {
      contact.hear();
      contact.say();
    } else {
      contact.say();
      contact.hear();
    }
}

std::chrono::milliseconds first_contact_patience() {
  return address_space() == RLIM_INFINITY ? std::chrono::milliseconds(0) : std::chrono::seconds(20);
}

}  // namespace tessera::exchange
