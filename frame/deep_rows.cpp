#include "frame/deep_rows.hpp"

#include <algorithm>
#include <cstring>
#include <utility>
#include <vector>

#include "scene/error.hpp"

namespace tessera::frame {
namespace {

using exchange::Bytes;

/// First row of a rank's band.
int first_row(int rank, int ranks, int height) {
  return static_cast<int>(static_cast<std::int64_t>(height) * rank / ranks);
}

/// Counts of the band's pixels, and their samples.
Bytes packed(const scene::DeepImage& image, int y0, int y1) {
  const auto width = static_cast<std::size_t>(image.size.width);
  const std::size_t first = static_cast<std::size_t>(y0) * width, last = static_cast<std::size_t>(y1) * width;
  std::vector<std::uint64_t> counts;
  for (std::size_t p = first; p < last; ++p) counts.push_back(image.begin[p + 1] - image.begin[p]);
  const auto head = std::as_bytes(std::span<const std::uint64_t>(counts));
  const auto samples = std::as_bytes(std::span(image.samples));
  Bytes bytes(head.begin(), head.end());
  bytes.insert(bytes.end(), samples.begin(), samples.end());
  return bytes;
}

void append(const Bytes& bytes, std::size_t pixels, scene::DeepImage& image) {
  std::vector<std::uint64_t> counts(pixels);
  std::uint64_t samples = 0;
  if (bytes.size() >= pixels * sizeof(std::uint64_t) && pixels > 0)
    std::memcpy(counts.data(), bytes.data(), pixels * sizeof(std::uint64_t));
  for (const std::uint64_t n : counts) {
    samples += n;
    image.begin.push_back(image.begin.back() + n);
  }
  const std::size_t head = pixels * sizeof(std::uint64_t), own = samples * sizeof(scene::DeepImageSample);
  if (bytes.size() != head + own)
    throw scene::Error(scene::ErrorCode::system_failure,
                       "exchange: a band of deep samples is of another length; all ranks must run the same program");
  const std::size_t before = image.samples.size();
  image.samples.resize(before + samples);
  if (own > 0) std::memcpy(image.samples.data() + before, bytes.data() + head, own);
}

}  // namespace

std::optional<scene::DeepImage> deep_rows(exchange::Transport& transport, const scene::SampleSource& source,
                                          const scene::Camera& camera, scene::ImageSize size,
                                          const scene::TransferFunction& function, const DeepSettings& settings,
                                          std::int32_t number) {
  // Bands would be taken for tiles of the flat picture by a rank 0 that still puts that together.
  exchange::gather_all(transport, {});
  const int rank = transport.rank(), ranks = transport.size();
  const auto row = [&](int r) { return first_row(r, ranks, size.height); };
  scene::DeepImage own = deep_image(source, camera, size, function, settings, row(rank), row(rank + 1));
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
    append(bands[static_cast<std::size_t>(r)],
           static_cast<std::size_t>(row(r + 1) - row(r)) * static_cast<std::size_t>(size.width), whole);
    bands[static_cast<std::size_t>(r)] = {};
  }
  return whole;
}

}  // namespace tessera::frame
