#include "exchange/first_contact.hpp"

#include <fmt/format.h>
#include <sys/resource.h>

#include "exchange/message.hpp"

namespace tessera::exchange {
namespace {

using Clock = std::chrono::steady_clock;

rlim_t address_space() {
  rlimit space{};
  return getrlimit(RLIMIT_AS, &space) == 0 ? space.rlim_cur : RLIM_INFINITY;
}

class Contact {
 public:
  Contact(Transport& transport, std::chrono::milliseconds patience)
      : transport_(transport), patience_(patience), end_(Clock::now() + patience) {}

  /// Until all others have said something, on rank 0; on others until rank 0 has.
  void hear() {
    for (int missing = transport_.rank() == 0 ? transport_.size() - 1 : 1; missing > 0;)
      if (const auto message = transport_.receive(Channel::agreement, std::chrono::milliseconds(100))) {
        MessageReader(message->bytes, message->from, MessageKind::barrier).finish();
        --missing;
      } else if (patience_.count() > 0 && Clock::now() > end_) {
        throw scene::Error(
            scene::ErrorCode::system_failure,
            fmt::format("MPI: rank {} of {} heard nothing of {} in {} seconds after the start; {}", transport_.rank(),
                        transport_.size(), transport_.rank() == 0 ? "another rank" : "the first",
                        std::chrono::ceil<std::chrono::seconds>(patience_).count(), memory_remedy()));
      }
  }

  void say() {
    const int from = transport_.rank() == 0 ? 1 : 0, to = transport_.rank() == 0 ? transport_.size() : 1;
    for (int rank = from; rank < to; ++rank)
      transport_.send(rank, Channel::agreement, begin_message(MessageKind::barrier));
  }

 private:
  Transport& transport_;
  std::chrono::milliseconds patience_;
  Clock::time_point end_;
};

}  // namespace

std::string memory_remedy() {
  const rlim_t space = address_space();
  if (space == RLIM_INFINITY) return "see the settings of MPI and of this machine";
  return fmt::format("a rank may use {} MiB of address space (ulimit -v), raise that limit", space >> 20);
}

void make_first_contact(Transport& transport, std::chrono::milliseconds patience) {
  if (transport.size() == 1) return;
  Contact contact(transport, patience);
  // Twice, so that rank 0 knows too that it was heard: who goes on alone would wait where nobody looks at the time.
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
