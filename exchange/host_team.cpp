#include "exchange/host_team.hpp"

#include <fmt/format.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <fstream>
#include <new>
#include <random>
#include <string>
#include <utility>

#ifdef __linux__
#include <fcntl.h>
#include <linux/futex.h>
#include <sys/syscall.h>
#endif

#include "exchange/collectives.hpp"
#include "scene/frame_watch.hpp"

namespace tessera::exchange {
namespace {

std::size_t whole_pages(std::size_t bytes) {
  const auto page = static_cast<std::size_t>(sysconf(_SC_PAGESIZE));
  return std::max<std::size_t>((bytes + page - 1) / page, 1) * page;
}

scene::Error no_memory(std::size_t bytes) {
  return {scene::ErrorCode::system_failure,
          fmt::format("memory ran out: ranks of this machine share {} MiB more than there are; use `share_memory` no, or "
                      "more machines",
                      (bytes >> 20) + 1)};
}

}  // namespace

#ifdef __linux__

SharedPages SharedPages::made(std::size_t bytes) {
  bytes = whole_pages(bytes);
  SharedPages pages(memfd_create("tessera", MFD_CLOEXEC), bytes);
  if (pages.descriptor_ < 0 || ftruncate(pages.descriptor_, static_cast<off_t>(bytes)) != 0) throw no_memory(bytes);
  return pages;
}

std::optional<SharedPages> SharedPages::opened(std::uint64_t process, int descriptor, std::size_t bytes) {
  const std::string path = fmt::format("/proc/{}/fd/{}", process, descriptor);
  SharedPages pages(open(path.c_str(), O_RDWR | O_CLOEXEC), whole_pages(bytes));
  struct stat found {};
  if (pages.descriptor_ < 0 || fstat(pages.descriptor_, &found) != 0 || !S_ISREG(found.st_mode) ||
      static_cast<std::size_t>(found.st_size) != pages.bytes_)
    return std::nullopt;
  return pages;
}

bool SharedPages::reserve(std::size_t first, std::size_t last) const {
  if (first >= last) return true;
  int fault = EINTR;
  while (fault == EINTR)
    fault = posix_fallocate(descriptor_, static_cast<off_t>(first), static_cast<off_t>(last - first));
  return fault == 0;
}

bool SharedPages::map() {
  void* const data = mmap(nullptr, bytes_, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_POPULATE, descriptor_, 0);
  if (data == MAP_FAILED) return false;
  data_ = static_cast<std::byte*>(data);
  return true;
}

namespace {

/// What tells whether two processes can see each other's descriptors; empty: unknown.
std::string machine() {
  std::string boot;
  std::getline(std::ifstream("/proc/sys/kernel/random/boot_id"), boot);
  struct stat processes {};
  if (boot.empty() || stat("/proc/self/ns/pid", &processes) != 0) return {};
  return fmt::format("{} {} {}", boot, processes.st_ino, geteuid());
}

/// Sleeps until the word is no longer `seen`, or for a while.
void wait_for_change(std::atomic<std::uint32_t>& word, std::uint32_t seen) {
  const timespec a_while{0, 10'000'000};
  syscall(SYS_futex, &word, FUTEX_WAIT, seen, &a_while, nullptr, 0);
}
void wake_all(std::atomic<std::uint32_t>& word) { syscall(SYS_futex, &word, FUTEX_WAKE, INT32_MAX, nullptr, nullptr, 0); }

}  // namespace

#else  // no pages, so no teams

SharedPages SharedPages::made(std::size_t bytes) { throw no_memory(bytes); }
std::optional<SharedPages> SharedPages::opened(std::uint64_t, int, std::size_t) { return std::nullopt; }
bool SharedPages::reserve(std::size_t, std::size_t) const { return false; }
bool SharedPages::map() { return false; }
namespace {
std::string machine() { return {}; }
void wait_for_change(std::atomic<std::uint32_t>&, std::uint32_t) {}
void wake_all(std::atomic<std::uint32_t>&) {}
}  // namespace

#endif

SharedPages::SharedPages(SharedPages&& other) noexcept
    : descriptor_(std::exchange(other.descriptor_, -1)),
      bytes_(other.bytes_),
      data_(std::exchange(other.data_, nullptr)) {}

SharedPages& SharedPages::operator=(SharedPages&& other) noexcept {
  if (this == &other) return *this;
  release();
  descriptor_ = std::exchange(other.descriptor_, -1);
  bytes_ = other.bytes_;
  data_ = std::exchange(other.data_, nullptr);
  return *this;
}

SharedPages::~SharedPages() { release(); }

void SharedPages::release() {
  close_descriptor();
  if (data_ != nullptr) munmap(std::exchange(data_, nullptr), bytes_);
}

void SharedPages::close_descriptor() {
  if (descriptor_ >= 0) close(std::exchange(descriptor_, -1));
}

/// What members tell each other.
struct HostTeam::Control {
  struct alignas(64) Member {
    std::atomic<std::uint64_t> at = 0;    ///< the barrier that it has come to: epoch << 32 | step
    std::atomic<std::uint64_t> left = 0;  ///< the epoch that it left last
    std::uint64_t words[2] = {};          ///< of gather(), of even and odd steps: who is one step on does not overwrite
  };
  std::uint64_t key = 0;                  ///< that the members were told, so that no other pages are taken for these
  std::atomic<std::uint32_t> changes = 0;
  std::atomic<std::uint64_t> drawn = 0;  ///< epoch << 32 | numbers drawn
  std::atomic<std::int32_t> descriptor = -1;  ///< of the first member, of the pages that are being handed out
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

HostTeam::Control& HostTeam::control() const { return *reinterpret_cast<Control*>(control_.data()); }

std::unique_ptr<HostTeam> HostTeam::form(Transport& transport, bool joins) {
  struct Offer {
    std::uint64_t process;
    std::uint64_t key;
    std::int64_t descriptor;
  };
  Bytes mine = begin_message(MessageKind::machine);
  const std::string own = joins ? machine() : std::string();
  append_text(mine, own);
  std::vector<int> ranks;
  int from = 0;
  for (const Bytes& message : gather_all(transport, std::move(mine))) {
    MessageReader reader(message, from, MessageKind::machine);
    if (reader.take_text() == own && !own.empty()) ranks.push_back(from);
    ++from;
  }
  const bool alone = ranks.size() < 2;
  std::optional<SharedPages> control;
  const std::size_t bytes = Control::bytes(ranks.size());
  Offer offer{static_cast<std::uint64_t>(getpid()), 0, -1};
  if (!alone && ranks.front() == transport.rank()) {
    try {
      control = SharedPages::made(bytes);
      std::random_device random;
      offer.key = std::uint64_t{random()} << 32 | random();
      if (control->reserve(0, bytes) && control->map()) {
        auto* const shared = new (control->data()) Control{};
        for (std::size_t m = 1; m < ranks.size(); ++m) new (&shared->members[m]) Control::Member{};
        shared->key = offer.key;
        offer.descriptor = control->descriptor();
      }
    } catch (const scene::Error&) {  // then each is alone
    }
  }
  const std::vector<Offer> offers = gather_values(transport, MessageKind::team_offer, offer);
  bool sees = false;
  if (!alone) {
    const Offer& taken = offers[static_cast<std::size_t>(ranks.front())];
    if (taken.descriptor >= 0 && ranks.front() != transport.rank()) {
      control = SharedPages::opened(taken.process, static_cast<int>(taken.descriptor), bytes);
      if (control && !control->map()) control.reset();
    }
    sees = control && control->data() != nullptr && reinterpret_cast<Control*>(control->data())->key == taken.key;
  }
  const std::vector<std::uint8_t> all = gather_values(transport, MessageKind::team_joined, std::uint8_t{sees});
  const bool every = !alone && std::all_of(ranks.begin(), ranks.end(),
                                           [&](int rank) { return all[static_cast<std::size_t>(rank)] != 0; });
  if (!every) return nullptr;
  control->close_descriptor();
  return std::unique_ptr<HostTeam>(new HostTeam(transport, std::move(ranks), std::move(*control)));
}

void HostTeam::begin() {
  ++epoch_;
  step_ = 0;
  arrive(false);
}

void HostTeam::leave() {
  control().members[rank_].left.store(epoch_, std::memory_order_release);
  control().changes.fetch_add(1, std::memory_order_release);
  wake_all(control().changes);
}

void HostTeam::barrier() { arrive(true); }

void HostTeam::arrive(bool may_stop) {
  Control& shared = control();
  const std::uint64_t here = epoch_ << 32 | step_++;
  shared.members[rank_].at.store(here, std::memory_order_release);
  shared.changes.fetch_add(1, std::memory_order_release);
  wake_all(shared.changes);
  for (;;) {
    const std::uint32_t seen = shared.changes.load(std::memory_order_acquire);
    bool all = true;
    for (std::size_t m = 0; m < ranks_.size(); ++m) {
      const Control::Member& member = shared.members[m];
      // First whether it has left: it may be in the next epoch already.
      if (may_stop && member.left.load(std::memory_order_acquire) == epoch_) throw scene::FrameStopped{};
      all = all && member.at.load(std::memory_order_acquire) >= here;
    }
    if (all) return;
    wait_for_change(shared.changes, seen);
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
  if (pages && bytes <= pages->bytes() && (pages->bytes() <= small || bytes >= pages->bytes() / 2)) return pages->data();
  pages.reset();
  bytes = whole_pages(bytes);
  Control& shared = control();
  const std::uint64_t process = gather(static_cast<std::uint64_t>(getpid())).front();
  if (rank_ == 0) {
    std::int32_t descriptor = -1;
    try {
      pages = SharedPages::made(bytes);
      descriptor = pages->descriptor();
    } catch (const scene::Error&) {  // told by the descriptor
    }
    shared.descriptor.store(descriptor, std::memory_order_release);
  }
  barrier();
  const std::int32_t descriptor = shared.descriptor.load(std::memory_order_acquire);
  if (rank_ != 0 && descriptor >= 0) pages = SharedPages::opened(process, descriptor, bytes);
  // Each member its share, so that it lies in memory near to it.
  const scene::Share own = scene::share_of(bytes, this);
  bool good = pages && pages->reserve(own.first, own.last);
  if (scene::least_of(std::uint64_t{good}, this) == 0) throw no_memory(bytes);
  good = pages->map();
  pages->close_descriptor();
  if (scene::least_of(std::uint64_t{good}, this) == 0) throw no_memory(bytes);
  return pages->data();
}

}  // namespace tessera::exchange
