// SPDX-License-Identifier: BSD-3-Clause
#include "exchange/host_team.hpp"

#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <new>
#include <utility>

#include "scene/frame_watch.hpp"

namespace tessera::exchange {

/// The data in shared memory through which members communicate.
struct HostTeam::Control {
  struct alignas(64) Member {
    std::atomic<std::uint64_t> at = 0;    ///< the barrier that the member has reached: epoch << 32 | step
    std::atomic<std::uint64_t> left = 0;  ///< the epoch that the member has left last
    std::uint64_t words[2] = {};  ///< the words of gather(), for even and odd steps, so that a member that is one step
                                  ///< ahead does not overwrite them
  };
  std::atomic<std::uint32_t> changes = 0;
  std::atomic<std::uint64_t> drawn = 0;       ///< epoch << 32 | numbers drawn
  std::atomic<std::int32_t> descriptor = -1;  ///< the first member's descriptor of the pages that are being shared
  alignas(64) Member members[1];

  static std::size_t bytes(std::size_t members) { return sizeof(Control) + (members - 1) * sizeof(Member); }
};
static_assert(std::atomic<std::uint64_t>::is_always_lock_free && std::atomic<std::uint32_t>::is_always_lock_free);

HostTeam::HostTeam(Transport& transport, std::vector<int> ranks, SharedPages control)
    : transport_(transport),
      ranks_(std::move(ranks)),
      rank_(static_cast<int>(std::find(ranks_.begin(), ranks_.end(), transport.rank()) - ranks_.begin())),
      control_(std::move(control)) {}

HostTeam::~HostTeam() = default;

HostTeam::Control& HostTeam::control() const { return *reinterpret_cast<Control*>(shared_data(control_)); }

std::unique_ptr<HostTeam> HostTeam::form(Transport& transport, bool joins) {
  auto shared = share_pages(transport, joins, Control::bytes, [](std::byte* pages, std::size_t ranks) {
    auto* const control = new (pages) Control{};
    for (std::size_t m = 1; m < ranks; ++m) new (&control->members[m]) Control::Member{};
  });
  if (!shared) return nullptr;
  return std::unique_ptr<HostTeam>(new HostTeam(transport, std::move(shared->ranks), std::move(shared->pages)));
}

void HostTeam::begin() {
  ++epoch_;
  step_ = 0;
  arrive(false);
}

void HostTeam::leave() {
  control().members[rank_].left.store(epoch_, std::memory_order_release);
  change(control().changes);
}

void HostTeam::barrier() { arrive(true); }

void HostTeam::arrive(bool may_stop) {
  Control& shared = control();
  const std::uint64_t here = epoch_ << 32 | step_++;
  shared.members[rank_].at.store(here, std::memory_order_release);
  change(shared.changes);
  for (;;) {
    const std::uint32_t seen = shared.changes.load(std::memory_order_acquire);
    bool all = true;
    for (std::size_t m = 0; m < ranks_.size(); ++m) {
      const Control::Member& member = shared.members[m];
      // Checks first whether the member has left, because it may already be in the next epoch.
      if (may_stop && member.left.load(std::memory_order_acquire) == epoch_) throw scene::FrameStopped{};
      all = all && member.at.load(std::memory_order_acquire) >= here;
    }
    if (all) return;
    wait_for_change(shared.changes, seen, std::chrono::milliseconds(10));
    transport_.check();
  }
}

std::vector<std::uint64_t> HostTeam::gather(std::uint64_t word) {
  Control& shared = control();
  const std::size_t place = step_ % 2;
  shared.members[rank_].words[place] = word;
  barrier();
  std::vector<std::uint64_t> words;
  for (std::size_t m = 0; m < ranks_.size(); ++m) words.push_back(shared.members[m].words[place]);
  return words;
}

std::uint32_t HostTeam::draw(std::uint32_t count) {
  std::atomic<std::uint64_t>& drawn = control().drawn;
  for (std::uint64_t seen = drawn.load();;) {
    const std::uint64_t next = seen >> 32 == (epoch_ & 0xffffffff) ? seen & 0xffffffff : 0;
    if (next >= count) return count;
    if (drawn.compare_exchange_weak(seen, epoch_ << 32 | (next + 1))) return static_cast<std::uint32_t>(next);
  }
}

std::byte* HostTeam::memory(Room room, std::size_t bytes) {
  constexpr std::size_t small = std::size_t{1} << 20;
  std::optional<SharedPages>& pages = rooms_[static_cast<std::size_t>(room)];
  if (pages && bytes <= pages->bytes() && (pages->bytes() <= small || bytes >= pages->bytes() / 2))
    return pages->data();
  pages.reset();
  Control& shared = control();
  const std::uint64_t process = gather(static_cast<std::uint64_t>(getpid())).front();
  if (rank_ == 0) {
    std::int32_t descriptor = -1;
    try {
      pages = SharedPages::made(bytes);
      descriptor = pages->descriptor();
    } catch (const scene::Error&) {  // reported by the descriptor
    }
    shared.descriptor.store(descriptor, std::memory_order_release);
  }
  barrier();
  const std::int32_t descriptor = shared.descriptor.load(std::memory_order_acquire);
  if (rank_ != 0 && descriptor >= 0) pages = SharedPages::opened(process, descriptor, bytes);
  // Each member allocates its share, so that this share is in memory close to the member.
  const scene::Share own = scene::share_of(bytes, this);
  bool good = pages && pages->reserve(own.first, own.last);
  if (scene::least_of(std::uint64_t{good}, this) == 0) throw no_shared_memory(bytes);
  good = pages->map();
  pages->close_descriptor();
  if (scene::least_of(std::uint64_t{good}, this) == 0) throw no_shared_memory(bytes);
  return pages->data();
}

}  // namespace tessera::exchange
