// SPDX-License-Identifier: BSD-3-Clause
#include "reference/suspicion.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <unordered_set>

namespace tessera::reference {
namespace {

/// The output function of Steele, Lea, Flood, "Fast Splittable Pseudorandom Number Generators", OOPSLA 2014.
std::uint64_t mixed(std::uint64_t z) {
  z = (z ^ z >> 30) * 0xbf58476d1ce4e5b9;
  z = (z ^ z >> 27) * 0x94d049bb133111eb;
  return z ^ z >> 31;
}

/// Returns a key that is different for each pixel.
std::uint64_t key(PixelIndex p) { return static_cast<std::uint64_t>(p.y) << 32 | static_cast<std::uint32_t>(p.x); }

struct Ranked {
  double key;  ///< highest first
  std::size_t pixel;
};

/// Returns the `most` pixels with the highest keys, in order.
std::vector<std::size_t> highest(std::vector<Ranked> pixels, std::size_t most) {
  most = std::min(most, pixels.size());
  const auto before = [](const Ranked& a, const Ranked& b) {
    return a.key != b.key ? a.key > b.key : a.pixel < b.pixel;
  };
  const auto end = pixels.begin() + static_cast<std::ptrdiff_t>(most);
  std::nth_element(pixels.begin(), end, pixels.end(), before);
  std::sort(pixels.begin(), end, before);
  std::vector<std::size_t> order;
  for (std::size_t i = 0; i < most; ++i) order.push_back(pixels[i].pixel);
  return order;
}

/// Moves the best pixel of each 8x8 block to the front. The order does not change otherwise.
void spread(std::vector<std::size_t>& pixels, int width) {
  constexpr std::size_t side = 8;
  std::unordered_set<std::size_t> met;
  const auto w = static_cast<std::size_t>(width);
  std::stable_partition(pixels.begin(), pixels.end(),
                        [&](std::size_t i) { return met.insert(i / w / side * w + i % w / side).second; });
}

}  // namespace

const char* name_of(Suspicion suspicion) {
  constexpr std::array<const char*, suspicions> names{"edge", "outlier", "block", "plateau", "estimate",
                                                      "step", "border",  "tie",   "depth"};
  return names[static_cast<std::size_t>(suspicion)];
}

void raise(float& score, float to) {
  std::atomic_ref<float> shared(score);
  float now = shared.load(std::memory_order_relaxed);
  while (now < to && !shared.compare_exchange_weak(now, to, std::memory_order_relaxed)) {
  }
}

double hashed(std::uint64_t n, std::uint64_t salt) {
  return static_cast<double>(mixed(n + mixed(salt + 0x9e3779b97f4a7c15)) >> 11) * 0x1p-53;
}

std::vector<PixelIndex> ranked(const SuspicionMap& map, scene::ImageSize size, std::size_t most) {
  // Weighted sampling without replacement: Efraimidis, Spirakis, "Weighted random sampling with a reservoir", IPL 2006.
  // Scores span many orders of magnitude, and only their order is meaningful. Their fourth roots are used as weights,
  // so that pixels with low scores have a chance.
  std::vector<Ranked> by_score, by_draw;
  for (std::size_t i = 0; i < map.size(); ++i) {
    if (!(map[i] > 0)) continue;
    const double score = map[i];
    by_score.push_back({score * (1 + 1e-6 * hashed(i, 1)), i});  // equal scores in random order
    by_draw.push_back({std::log(1 - hashed(i, 2)) / std::sqrt(std::sqrt(score)), i});
  }
  const std::vector<std::size_t> strongest = highest(std::move(by_score), 16 * most);
  std::vector<std::size_t> scattered = strongest;
  spread(scattered, size.width);
  const std::vector<std::size_t> drawn = highest(std::move(by_draw), most);
  std::vector<PixelIndex> order;
  std::unordered_set<std::size_t> taken;
  const auto take = [&](const std::vector<std::size_t>& from, std::size_t& next) {
    while (next < from.size() && !taken.insert(from[next]).second) ++next;
    if (next == from.size()) return;
    const auto i = static_cast<std::ptrdiff_t>(from[next++]);
    order.push_back({static_cast<int>(i % size.width), static_cast<int>(i / size.width)});
  };
  const std::array<const std::vector<std::size_t>*, 3> lists{&strongest, &scattered, &drawn};
  std::array<std::size_t, 3> next{};
  for (std::size_t before = most; order.size() < most && order.size() != before;) {
    before = order.size();
    for (std::size_t n = 0; n < lists.size(); ++n)
      if (order.size() < most) take(*lists[n], next[n]);
  }
  return order;
}

std::vector<ChosenPixel> by_turns(const Suspects& suspects, std::size_t most) {
  std::vector<ChosenPixel> chosen;
  std::unordered_set<std::uint64_t> taken;
  std::array<std::size_t, suspicions> next{};
  for (bool any = true; any && chosen.size() < most;) {
    any = false;
    for (std::size_t kind = 0; kind < suspicions && chosen.size() < most; ++kind) {
      const std::vector<PixelIndex>& of_kind = suspects[kind];
      while (next[kind] < of_kind.size() && !taken.insert(key(of_kind[next[kind]])).second) ++next[kind];
      if (next[kind] == of_kind.size()) continue;
      chosen.push_back({of_kind[next[kind]++], static_cast<Suspicion>(kind)});
      any = true;
    }
  }
  return chosen;
}

std::vector<ChosenPixel> choose_pixels(scene::ImageSize size, std::size_t count, const Suspects& suspects) {
  constexpr std::uint64_t seed = 1;
  std::vector<ChosenPixel> chosen;
  std::unordered_set<std::uint64_t> taken;
  const auto take = [&](const ChosenPixel& pixel) {
    if (chosen.size() < count && taken.insert(key(pixel.at)).second) chosen.push_back(pixel);
  };
  const std::uint64_t total = static_cast<std::uint64_t>(size.width) * static_cast<std::uint64_t>(size.height);
  count = static_cast<std::size_t>(std::min<std::uint64_t>(count, total));
  const std::size_t suspicious = count < total ? 2 * count / 3 : 0;
  for (const PixelIndex& p : random_pixels(size, count - suspicious, seed)) take({p, std::nullopt});
  // Some of these may have been chosen at random before.
  if (suspicious > 0)
    for (const ChosenPixel& pixel : by_turns(suspects, count)) take(pixel);
  std::vector<PixelIndex> more = random_pixels(size, count, seed + 1);
  std::sort(more.begin(), more.end(),
            [](const PixelIndex& a, const PixelIndex& b) { return hashed(key(a), 3) < hashed(key(b), 3); });
  for (const PixelIndex& p : more) take({p, std::nullopt});
  std::stable_partition(chosen.begin(), chosen.end(), [](const ChosenPixel& c) { return !c.why; });
  return chosen;
}

}  // namespace tessera::reference
