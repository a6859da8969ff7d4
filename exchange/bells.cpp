// SPDX-License-Identifier: BSD-3-Clause
#include "exchange/bells.hpp"

#include <new>
#include <utility>

namespace tessera::exchange {
namespace {

/// Each bell has a separate cache line.
struct alignas(64) Bell {
  std::atomic<std::uint32_t> rung = 0;
};

}  // namespace

std::shared_ptr<Bells> Bells::hung(Transport& transport) {
  auto shared = share_pages(
      transport, true, [](std::size_t ranks) { return ranks * sizeof(Bell); },
      [](std::byte* pages, std::size_t ranks) {
        for (std::size_t r = 0; r < ranks; ++r) new (pages + r * sizeof(Bell)) Bell{};
      });
  if (!shared) return nullptr;
  return std::shared_ptr<Bells>(new Bells(transport, std::move(*shared)));
}

Bells::Bells(Transport& transport, PagesOfMachine shared)
    : pages_(std::move(shared.pages)),
      places_(static_cast<std::size_t>(transport.size()), -1),
      of_all_(shared.ranks.size() == static_cast<std::size_t>(transport.size())) {
  int place = 0;
  for (const int rank : shared.ranks) places_[static_cast<std::size_t>(rank)] = place++;
  own_ = places_[static_cast<std::size_t>(transport.rank())];
}

std::atomic<std::uint32_t>& Bells::bell(int place) const {
  return reinterpret_cast<Bell*>(shared_data(pages_))[place].rung;
}

void Bells::ring(int rank) {
  if (const int place = places_[static_cast<std::size_t>(rank)]; place >= 0) change(bell(place));
}

std::uint32_t Bells::heard() const { return bell(own_).load(std::memory_order_acquire); }

void Bells::wait(std::uint32_t heard, std::chrono::microseconds most) { wait_for_change(bell(own_), heard, most); }

}  // namespace tessera::exchange
