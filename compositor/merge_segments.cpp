#include <fmt/format.h>

#include <limits>
#include <memory>
#include <utility>
#include <vector>

#include "compositor/deep_sink.hpp"
#include "compositor/merge_kinds.hpp"
#include "compositor/tile_pixels.hpp"
#include "compositor/tuple_record.hpp"
#include "compositor/two_sinks.hpp"
#include "projection/ray_segments.hpp"
#include "sorting/pixel_lists.hpp"

namespace tessera::compositor {
namespace {

using Key = sorting::PixelLists::Key;

/// Raw segments: sorted and integrated here, by the code that does it for a single process.
class SegmentMerger : public TileMerger {
 public:
  SegmentMerger(const MergeContext& context, const scene::PixelRect& rect, Key key = Key::front)
      : budget_(context.budget_bytes),
        rect_(rect),
        key_(key),
        image_({rect.x1 - rect.x0, rect.y1 - rect.y0}),
        sink_(std::make_unique<TilePixels>(*context.space, *context.integrator, context.max_color, context.longest_ray,
                                           context.emission, ImageWindow{&image_, rect.x0, rect.y0})) {
    if (context.deep_accuracy > 0)
      sink_ = std::make_unique<TwoSinks>(
          std::move(sink_),
          std::make_unique<DeepSink>(*context.space, *context.integrator, *context.function, context.longest_ray,
                                     context.emission, context.deep_accuracy, deep_));
    sink_->start(rect);
  }

  void add(const exchange::TilePart& part) override {
    const bool cell_data = part.kind == exchange::RecordKind::chains_of_cells;
    reserve(segments_.size + part.fragments);
    exchange::RecordReader reader(part.records.bytes());
    while (!reader.empty()) {
      const auto chain = reader.take<exchange::ChainHeader>();
      check_room(part.tile, chain.pixel, chain.links);
      double front = chain.front, scalar = chain.scalar_front;
      for (std::uint32_t i = 0; i < chain.links; ++i) {
        const auto link = reader.take<exchange::ChainLink>();
        const std::size_t at = segments_.size++;
        segments_.pixel_and_tet[at] = link.tet << 32 | chain.pixel;
        segments_.front[at] = front;
        segments_.back[at] = link.back;
        segments_.scalar_front[at] = cell_data ? link.scalar : scalar;
        segments_.scalar_back[at] = link.scalar;
        front = link.back;
        scalar = link.scalar;
      }
    }
  }

  void advance(double final_depth) override {
    lists_.sort(segments_, static_cast<std::size_t>(rect_.area()), key_);
    sink_->take(segments_, lists_, final_depth);
    const std::vector<double>& depth = key_ == Key::front ? segments_.front : segments_.back;
    std::size_t kept = 0;
    for (std::size_t i = 0; i < segments_.size; ++i)
      if (!(depth[i] < final_depth) && sink_->open(segments_.pixel(i))) segments_.move(i, kept++);
    segments_.size = kept;
  }

  MergedTile finish() override {
    sink_->finish();
    return {std::move(image_), std::move(deep_.counts), std::move(deep_.samples)};
  }

 protected:
  projection::RaySegments& segments() { return segments_; }

  void check_room(std::uint32_t tile, std::uint32_t pixel, std::size_t more) const {
    if (pixel >= static_cast<std::uint32_t>(rect_.area()) || more > segments_.capacity() - segments_.size)
      throw scene::Error(
          scene::ErrorCode::system_failure,
          fmt::format("exchange: the segments of tile {} are malformed; all ranks must run the same program", tile));
  }

  void reserve(std::size_t segments) {
    if (segments <= segments_.capacity()) return;
    constexpr std::size_t each =
        projection::RaySegments::bytes_each + sorting::PixelLists::bytes_each + integrals::SegmentBatch::bytes_each;
    if (segments * each > budget_ || segments > std::numeric_limits<std::uint32_t>::max())
      throw scene::Error(scene::ErrorCode::system_failure,
                         fmt::format("the tile at pixel {},{} holds {} ray segments at once, beyond the memory budget; "
                                     "raise `memory` or make `tile_size` smaller",
                                     rect_.x0, rect_.y0, segments));
    segments_.reserve(std::min<std::size_t>(std::max(segments, 2 * segments_.capacity()), budget_ / each));
  }

 private:
  std::uint64_t budget_;
  scene::PixelRect rect_;
  Key key_;
  scene::Image image_;
  /// The samples of the tile, which DeepSink gives all at once.
  struct Deep final : DeepTarget {
    void add(const scene::PixelRect&, std::vector<std::uint32_t> c, std::vector<scene::DeepImageSample> s) override {
      counts = std::move(c);
      samples = std::move(s);
    }
    std::vector<std::uint32_t> counts;
    std::vector<scene::DeepImageSample> samples;
  } deep_;
  std::unique_ptr<TileSink> sink_;
  projection::RaySegments segments_;
  sorting::PixelLists lists_;
};

/// The paper's tuples, whose key is the back alone. Equal ones stand by projector, then as they came: the order of
/// cells.
class TupleMerger final : public SegmentMerger {
 public:
  TupleMerger(const MergeContext& context, const scene::PixelRect& rect)
      : SegmentMerger(context, rect, Key::back), longest_edge_(context.longest_edge) {}

  void add(const exchange::TilePart& part) override {
    reserve(segments().size + part.fragments);
    exchange::RecordReader reader(part.records.bytes());
    while (!reader.empty()) {
      const auto record = reader.take<TupleRecord>();
      check_room(part.tile, record.pixel, 1);
      // 2^22 arrivals before the number comes round are more than the ties of any one depth.
      const auto arrival = static_cast<std::uint32_t>(part.projector) << 22 | (arrivals_++ & 0x3fffff);
      projection::from_tuple(record.tuple, record.pixel, arrival, longest_edge_, segments(), segments().size);
      ++segments().size;
    }
  }

 private:
  float longest_edge_;
  std::uint32_t arrivals_ = 0;
};

}  // namespace

std::unique_ptr<TileMerger> make_tuple_merger(const MergeContext& context, const scene::PixelRect& rect) {
  return std::make_unique<TupleMerger>(context, rect);
}

std::unique_ptr<TileMerger> make_segment_merger(const MergeContext& context, const scene::PixelRect& rect) {
  return std::make_unique<SegmentMerger>(context, rect);
}

}  // namespace tessera::compositor
