// SPDX-License-Identifier: BSD-3-Clause
#include "frame/grid/deep_rows.hpp"

#include <algorithm>
#include <utility>
#include <vector>

#include "exchange/collectives.hpp"
#include "frame/ranks/reduce.hpp"
#include "scene/frame_watch.hpp"

namespace tessera::frame {
namespace {

using exchange::Bytes;

/// Returns the first row of a rank's band.
int first_row(int rank, int ranks, int height) {
  return static_cast<int>(static_cast<std::int64_t>(height) * rank / ranks);
}

/// Packs the numbers of samples of the band's pixels, and the samples.
Bytes packed(const scene::DeepImage& image, int y0, int y1) {
  const auto width = static_cast<std::size_t>(image.size.width);
  const std::size_t first = static_cast<std::size_t>(y0) * width, last = static_cast<std::size_t>(y1) * width;
  std::vector<std::uint64_t> counts;
  for (std::size_t p = first; p < last; ++p) counts.push_back(image.begin[p + 1] - image.begin[p]);
  Bytes bytes = exchange::begin_message(
      exchange::MessageKind::deep_rows,
      counts.size() * sizeof(std::uint64_t) + image.samples.size() * sizeof(scene::DeepImageSample));
  exchange::append_values(bytes, counts);
  exchange::append_values(bytes, image.samples);
  return bytes;
}

void append(const Bytes& bytes, int from, std::size_t pixels, scene::DeepImage& image) {
  exchange::MessageReader reader(bytes, from, exchange::MessageKind::deep_rows);
  std::vector<std::uint64_t> counts;
  reader.take_onto(counts, pixels);
  std::uint64_t samples = 0;
  for (const std::uint64_t n : counts) {
    if (n > bytes.size()) reader.refuse("has more samples than bytes");
    samples += n;
    image.begin.push_back(image.begin.back() + n);
  }
  reader.take_onto(image.samples, samples);
  reader.finish();
}

}  // namespace

std::optional<scene::DeepImage> deep_rows(exchange::Transport& transport, const scene::SampleSource& source,
                                          const scene::Camera& camera, scene::ImageSize size,
                                          const scene::TransferFunction& function, const DeepSettings& settings,
                                          std::int32_t number, const std::stop_token& stop) {
  // Without this barrier, rank 0 could mistake bands for tiles of the flat image while it still assembles that image.
  exchange::barrier(transport);
  const int rank = transport.rank(), ranks = transport.size();
  const auto row = [&](int r) { return first_row(r, ranks, size.height); };
  scene::DeepImage own;
  bool stopped = false;
  try {
    own = deep_image(source, camera, size, function, settings, row(rank), row(rank + 1), stop);
  } catch (const scene::FrameStopped&) {
    stopped = true;
  }
  // A rank that finished before the stop throws, too, like the others.
  if (ranks > 1) stopped = reduce_all(transport, {stopped ? 1u : 0u}, Reduction::sum)[0] > 0;
  if (stopped) throw scene::FrameStopped();
  if (ranks == 1) return own;
  Bytes bytes = packed(own, row(rank), row(rank + 1));
  own = {};
  if (rank != 0) {
    transport.send(0, exchange::Channel::tiles, std::move(bytes), number);
    return std::nullopt;
  }
  std::vector<Bytes> bands(static_cast<std::size_t>(ranks));
  bands[0] = std::move(bytes);
  for (int others = ranks - 1; others > 0; --others) {
    exchange::Message message = transport.receive(exchange::Channel::tiles);
    bands[static_cast<std::size_t>(message.from)] = std::move(message.bytes);
  }
  scene::DeepImage whole;
  whole.size = size;
  whole.begin = {0};
  for (int r = 0; r < ranks; ++r) {
    append(bands[static_cast<std::size_t>(r)], r,
           static_cast<std::size_t>(row(r + 1) - row(r)) * static_cast<std::size_t>(size.width), whole);
    bands[static_cast<std::size_t>(r)] = {};
  }
  return whole;
}

}  // namespace tessera::frame
