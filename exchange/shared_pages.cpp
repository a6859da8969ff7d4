// SPDX-License-Identifier: BSD-3-Clause
#include "exchange/shared_pages.hpp"

#include <fmt/format.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <limits>
#include <random>
#include <string>
#include <utility>

#ifdef __linux__
#include <fcntl.h>
#include <linux/futex.h>
#include <sys/syscall.h>
#else
#include <thread>
#endif

#include "exchange/collectives.hpp"

namespace tessera::exchange {
namespace {

std::size_t whole_pages(std::size_t bytes) {
  const auto page = static_cast<std::size_t>(sysconf(_SC_PAGESIZE));
  return std::max<std::size_t>((bytes + page - 1) / page, 1) * page;
}

}  // namespace

std::uint64_t available_memory() {
  std::ifstream facts("/proc/meminfo");
  for (std::string name, rest; facts >> name; std::getline(facts, rest))
    if (std::uint64_t kibibytes = 0; name == "MemAvailable:" && facts >> kibibytes) return kibibytes << 10;
  return std::numeric_limits<std::uint64_t>::max();
}

scene::Error no_shared_memory(std::size_t bytes) {
  return {scene::ErrorCode::system_failure,
          fmt::format("memory ran out: the ranks of this machine share {} MiB more than it has; switch off sharing "
                      "(`without`), or use more machines",
                      (bytes >> 20) + 1)};
}

#ifdef __linux__

SharedPages SharedPages::made(std::size_t bytes) {
  if (bytes > available_memory()) throw no_shared_memory(bytes);
  bytes = whole_pages(bytes);
  SharedPages pages(memfd_create("tessera", MFD_CLOEXEC), bytes);
  if (pages.descriptor_ < 0 || ftruncate(pages.descriptor_, static_cast<off_t>(bytes)) != 0)
    throw no_shared_memory(bytes);
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

std::string machine() {
  std::string boot;
  std::getline(std::ifstream("/proc/sys/kernel/random/boot_id"), boot);
  struct stat processes {};
  struct stat network {};
  if (boot.empty() || stat("/proc/self/ns/pid", &processes) != 0 || stat("/proc/self/ns/net", &network) != 0) return {};
  return fmt::format("{} {} {} {}", boot, processes.st_ino, network.st_ino, geteuid());
}

void wait_for_change(std::atomic<std::uint32_t>& word, std::uint32_t seen, std::chrono::microseconds most) {
  const auto count = most.count();
  const timespec time{count / 1'000'000, count % 1'000'000 * 1000};
  syscall(SYS_futex, &word, FUTEX_WAIT, seen, &time, nullptr, 0);
}

void change(std::atomic<std::uint32_t>& word) {
  word.fetch_add(1, std::memory_order_release);
  syscall(SYS_futex, &word, FUTEX_WAKE, INT32_MAX, nullptr, nullptr, 0);
}

#else  // no shared pages, so no teams

SharedPages SharedPages::made(std::size_t bytes) { throw no_shared_memory(bytes); }
std::optional<SharedPages> SharedPages::opened(std::uint64_t, int, std::size_t) { return std::nullopt; }
bool SharedPages::reserve(std::size_t, std::size_t) const { return false; }
bool SharedPages::map() { return false; }
std::string machine() { return {}; }
void wait_for_change(std::atomic<std::uint32_t>& word, std::uint32_t seen, std::chrono::microseconds most) {
  if (word == seen) std::this_thread::sleep_for(std::min(most, std::chrono::microseconds(100)));
}
void change(std::atomic<std::uint32_t>& word) { ++word; }

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

std::optional<PagesOfMachine> share_pages(Transport& transport, bool joins,
                                          const std::function<std::size_t(std::size_t ranks)>& bytes_for,
                                          const std::function<void(std::byte* pages, std::size_t ranks)>& fill) {
  struct Offer {
    std::uint64_t process;
    std::uint64_t key;  // identifies these pages, so that no others are used
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
    reader.finish();
    ++from;
  }
  const bool alone = ranks.size() < 2;
  std::optional<SharedPages> pages;
  const std::size_t bytes = shared_data_offset + (alone ? 0 : bytes_for(ranks.size()));
  Offer offer{static_cast<std::uint64_t>(getpid()), 0, -1};
  if (!alone && ranks.front() == transport.rank()) {
    try {
      pages = SharedPages::made(bytes);
      std::random_device random;
      offer.key = std::uint64_t{random()} << 32 | random();
      if (pages->reserve(0, bytes) && pages->map()) {
        std::memcpy(pages->data(), &offer.key, sizeof offer.key);
        fill(shared_data(*pages), ranks.size());
        offer.descriptor = pages->descriptor();
      }
    } catch (const scene::Error&) {  // each rank works alone
    }
  }
  const std::vector<Offer> offers = gather_values(transport, MessageKind::pages_offer, offer);
  bool sees = false;
  if (!alone) {
    const Offer& taken = offers[static_cast<std::size_t>(ranks.front())];
    if (taken.descriptor >= 0 && ranks.front() != transport.rank()) {
      pages = SharedPages::opened(taken.process, static_cast<int>(taken.descriptor), bytes);
      if (pages && !pages->map()) pages.reset();
    }
    sees = pages && pages->data() != nullptr && std::memcmp(pages->data(), &taken.key, sizeof taken.key) == 0;
  }
  const std::vector<std::uint8_t> all = gather_values(transport, MessageKind::pages_seen, std::uint8_t{sees});
  const bool every = !alone && std::all_of(ranks.begin(), ranks.end(),
                                           [&](int rank) { return all[static_cast<std::size_t>(rank)] != 0; });
  if (!every) return std::nullopt;
  pages->close_descriptor();
  return PagesOfMachine{std::move(ranks), std::move(*pages)};
}

}  // namespace tessera::exchange
