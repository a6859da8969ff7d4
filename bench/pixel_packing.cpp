// SPDX-License-Identifier: BSD-3-Clause
/// The cost of sending finished pixels to the rank that assembles the image (exchange/packed_pixels.hpp): bytes per
/// pixel, and nanoseconds per pixel of one core to pack and unpack them, compared with copying them unpacked.
///
/// Usage: pixel_packing IMAGE.exr ...; prints one Markdown row per image. Times are processor time, the minimum of
/// some repetitions. Tiles of 32 x 32 pixels as in a run, in random order, as they arrive; empty tiles count with their
/// pixels but without bytes or time, because compositors do not send them.
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <limits>
#include <numeric>
#include <random>
#include <span>
#include <vector>

#include "cpu_time.hpp"
#include "exchange/packed_pixels.hpp"
#include "projection/tile_lists.hpp"
#include "tessera/image_file.hpp"

using namespace tessera;

namespace {

bool is_empty(const Image& image, const PixelRect& rect) {
  for (int y = rect.y0; y < rect.y1; ++y)
    for (int x = rect.x0; x < rect.x1; ++x)
      if (image.rgba[4 * image.index(x, y) + 3] != 0) return false;
  return true;
}

/// An image's non-empty tiles, each an image as in compositors.
struct Tiles {
  std::vector<PixelRect> rects;
  std::vector<Image> images;
};

Tiles tiles_of(const Image& picture) {
  const projection::TileGrid grid{picture.size, 32};
  std::vector<std::size_t> order(grid.count());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::shuffle(order.begin(), order.end(), std::mt19937(1));
  Tiles tiles;
  for (const std::size_t t : order) {
    const PixelRect rect = grid.rect(t);
    if (is_empty(picture, rect)) continue;
    Image tile({rect.width(), rect.height()});
    for (int y = 0; y < rect.height(); ++y) {
      const std::size_t from = picture.index(rect.x0, rect.y0 + y), to = tile.index(0, y);
      std::copy_n(&picture.rgba[4 * from], 4 * rect.width(), &tile.rgba[4 * to]);
      std::copy_n(&picture.depth[from], rect.width(), &tile.depth[to]);
    }
    tiles.rects.push_back(rect);
    tiles.images.push_back(std::move(tile));
  }
  return tiles;
}

struct Cost {
  std::size_t bytes = 0;
  double append = std::numeric_limits<double>::infinity(), take = append;  ///< seconds
};

Cost cost_of(const Tiles& tiles, bool pack, Image& into) {
  Cost cost;
  std::vector<exchange::Bytes> messages(tiles.images.size());
  for (int repetition = 0; repetition < 9; ++repetition) {
    double begin = bench::thread_seconds();
    for (std::size_t t = 0; t < messages.size(); ++t) {
      messages[t].clear();
      const ImageSize size = tiles.images[t].size;
      exchange::append_pixels(messages[t], tiles.images[t], {0, 0, size.width, size.height}, pack);
    }
    cost.append = std::min(cost.append, bench::thread_seconds() - begin);
    begin = bench::thread_seconds();
    for (std::size_t t = 0; t < messages.size(); ++t) {
      exchange::RecordReader reader(messages[t]);
      exchange::take_pixels(reader, into, tiles.rects[t]);
    }
    cost.take = std::min(cost.take, bench::thread_seconds() - begin);
  }
  for (const exchange::Bytes& message : messages) cost.bytes += message.size();
  return cost;
}

}  // namespace

int main(int count, char** words) {
  fmt::print(
      "| image | bytes per pixel: unpacked | packed | ns per pixel: append | pack | place | unpack |\n"
      "|---|---:|---:|---:|---:|---:|---:|\n");
  for (const char* word : std::span(words, static_cast<std::size_t>(count)).subspan(1)) {
    const std::filesystem::path file(word);
    const Image picture = read_image(file);
    const Tiles tiles = tiles_of(picture);
    Image into(picture.size);
    const Cost raw = cost_of(tiles, false, into), packed = cost_of(tiles, true, into);
    if (into.rgba != picture.rgba || into.depth != picture.depth) {
      fmt::print(stderr, "pixel_packing: {}: it is another picture now\n", word);
      return 1;
    }
    const auto pixels = static_cast<double>(picture.depth.size());
    fmt::print("| {} | {:.2f} | {:.2f} | {:.2f} | {:.2f} | {:.2f} | {:.2f} |\n", file.filename().string(),
               static_cast<double>(raw.bytes) / pixels, static_cast<double>(packed.bytes) / pixels,
               1e9 * raw.append / pixels, 1e9 * packed.append / pixels, 1e9 * raw.take / pixels,
               1e9 * packed.take / pixels);
  }
}
