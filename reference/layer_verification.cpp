// SPDX-License-Identifier: BSD-3-Clause
#include "reference/layer_verification.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace tessera::reference {
namespace {

/// One layer. Known pixels are stored, the others are computed.
class OneLayer final : public RayReference {
 public:
  OneLayer(const LayerReference& reference, const Peel& peel, scene::ImageSize size, std::size_t number,
           const std::vector<std::vector<Pixel>>& known)
      : reference_(reference), peel_(peel), size_(size), number_(number), known_(known) {}

  [[nodiscard]] Pixel pixel(double x, double y) const override { return reference_.layers(x, y, peel_)[number_]; }
  [[nodiscard]] std::vector<Pixel> pixels(std::span<const PixelIndex> /*those known*/, int /*threads*/) const override {
    std::vector<Pixel> pixels;
    for (const std::vector<Pixel>& layers : known_) pixels.push_back(layers[number_]);
    return pixels;
  }
  [[nodiscard]] scene::ImageSize size() const override { return size_; }

 private:
  const LayerReference& reference_;
  Peel peel_;
  scene::ImageSize size_;
  std::size_t number_;
  const std::vector<std::vector<Pixel>>& known_;
};

}  // namespace

LayerVerification verify_layers(std::span<const scene::Image> layers, const LayerReference& reference, const Peel& peel,
                                double bound, std::size_t count, const Suspects& suspects, int threads) {
  LayerVerification found;
  found.bound = bound;
  if (layers.empty()) return found;
  const scene::ImageSize size = layers.front().size;
  const std::vector<ChosenPixel> pixels = choose_pixels(size, count, suspects);
  std::vector<PixelIndex> places;
  places.reserve(pixels.size());
  for (const ChosenPixel& pixel : pixels) places.push_back(pixel.at);
  const std::vector<std::vector<Pixel>> truths = reference.layers(places, peel, threads);
  for (std::size_t n = 0; n < layers.size(); ++n) {
    const OneLayer truth(reference, peel, size, n, truths);
    const std::vector<PixelJudgement> judged = judge_each(layers[n], truth, bound, places, threads, places.size());
    Tally& tally = found.layers.emplace_back();
    std::size_t random = 0, random_excused = 0;
    for (std::size_t i = 0; i < judged.size(); ++i) {
      ++tally.pixels;
      tally.max_error = std::max(tally.max_error, judged[i].error);
      tally.over_bound += judged[i].over_bound ? 1 : 0;
      tally.excused += judged[i].excused ? 1 : 0;
      random += pixels[i].why ? 0 : 1;
      random_excused += !pixels[i].why && judged[i].excused ? 1 : 0;
    }
    const bool sample = random < layers[n].depth.size();
    if (tally.over_bound != tally.excused || random_excused > most_excused(random, sample)) found.met = false;
    if (!std::isfinite(tally.max_error)) found.met = false;
  }
  return found;
}

}  // namespace tessera::reference
