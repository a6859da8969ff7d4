// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <utility>
#include <vector>

#include "compositor/deep/deep_sink.hpp"
#include "compositor/deep/lattice_deep_sink.hpp"
#include "compositor/deep/layer_sink.hpp"
#include "compositor/deep/peel_sink.hpp"
#include "compositor/merge_kinds.hpp"
#include "compositor/picture_sink.hpp"
#include "compositor/tuple_record.hpp"
#include "projection/surface_crossings.hpp"

namespace tessera::compositor {
namespace {

scene::Error malformed(std::uint32_t tile) {
  return {scene::ErrorCode::system_failure,
          fmt::format("exchange: the segments of tile {} are malformed; all ranks must run the same program", tile)};
}

/// Merges segments with the sinks that also sort, integrate and composite segments in a single process. A derived class
/// for each kind of record adds the segments to the stores.
template <class Encoding>
class SegmentMerger : public TileMerger {
 public:
  void advance(double final_depth) override {
    scene::StageTimer timer(context_.trace);
    for (Square& square : squares_)
      if (square.sink) square.sink->take(square.store, first_from(final_depth), 1, timer);
  }

  MergedTile finish() override {
    for (Square& square : squares_)
      if (square.sink) square.sink->finish();
    if (!makes_samples()) return {std::move(image_), {}, {}};
    scene::DeepImage deep = deep_.collector.image();
    std::vector<std::uint32_t> counts(deep.begin.size() - 1);
    for (std::size_t p = 0; p < counts.size(); ++p)
      counts[p] = static_cast<std::uint32_t>(deep.begin[p + 1] - deep.begin[p]);
    return {std::move(image_), std::move(counts), std::move(deep.samples)};
  }

 protected:
  /// The rectangle of one store. It has no sink until the store is opened.
  struct Square {
    scene::PixelRect rect;
    typename Encoding::Store store;
    std::unique_ptr<TileSink<Encoding>> sink;
  };

  SegmentMerger(const MergeContext& context, const scene::PixelRect& rect)
      : context_(context),
        scene_{context.space,
               context.integrator,
               context.opacity_weight(),
               context.table,
               context.lattice != nullptr ? *context.lattice : scene::Lattice{},
               context.surfaces,
               context.light},
        rect_(rect),
        image_({rect.width(), rect.height()}),
        deep_(rect) {}

  [[nodiscard]] bool makes_samples() const { return context_.peel.has_value() || context_.deep_accuracy > 0; }

  void open(Square& square) {
    const ImageWindow window{&image_, rect_.x0, rect_.y0};
    if constexpr (std::is_same_v<Encoding, DoubleEncoding>) {
      if (context_.peel)
        square.sink =
            std::make_unique<PeelSink>(scene_, window, *context_.function, context_.emission, *context_.peel, deep_);
      else if (context_.deep_accuracy > 0)
        square.sink = std::make_unique<DeepSink>(scene_, window, *context_.function, context_.emission,
                                                 context_.deep_accuracy, deep_);
    } else if (context_.peel) {
      square.sink = std::make_unique<LayerSink>(scene_, window, *context_.function, *context_.peel, deep_);
    } else if (context_.deep_accuracy > 0) {
      square.sink = std::make_unique<LatticeDeepSink>(scene_, window, context_.deep_accuracy, deep_);
    }
    if (!square.sink) square.sink = std::make_unique<PictureSink<Encoding>>(scene_, window);
    square.sink->start(square.rect);
  }

  /// Returns the first depth of the encoding that is not before `depth`.
  [[nodiscard]] virtual typename Encoding::Depth first_from(double depth) const = 0;

  MergeContext context_;
  TileScene scene_;
  scene::PixelRect rect_;
  std::vector<Square> squares_;

 private:
  scene::Image image_;
  /// Collects the samples of the tile from the sinks of its squares.
  struct Deep final : DeepTarget {
    explicit Deep(const scene::PixelRect& of)
        : tile(of), collector({of.width(), of.height()}, std::numeric_limits<std::uint64_t>::max()) {}
    void add(const scene::PixelRect& rect, std::vector<std::uint32_t> counts,
             std::vector<scene::DeepImageSample> samples) override {
      const int x = tile.x0, y = tile.y0;
      collector.add({rect.x0 - x, rect.y0 - y, rect.x1 - x, rect.y1 - y}, std::move(counts), std::move(samples));
    }
    scene::PixelRect tile;
    DeepCollector collector;
  } deep_;
};

/// Segments in double precision, in chains; one store for the tile.
class ChainMerger : public SegmentMerger<DoubleEncoding> {
 public:
  using Key = sorting::SegmentLists::Key;

  ChainMerger(const MergeContext& context, const scene::PixelRect& rect, Key key = Key::front)
      : SegmentMerger(context, rect) {
    scene_.normals = &sent_;
    squares_.push_back({rect, {}, nullptr});
    squares_[0].store.reset(static_cast<std::size_t>(rect.area()), key);
    open(squares_[0]);
  }

  void advance(double final_depth) override {
    SegmentMerger::advance(final_depth);
    sent_.forget(squares_[0].store.segments);
  }

  void add(const exchange::TilePart& part) override {
    const bool lit = part.kind == exchange::RecordKind::lit_chains;
    const bool cell_data = part.kind == exchange::RecordKind::chains_of_cells;
    projection::RaySegments& segments = reserve(part.fragments);
    exchange::RecordReader reader(part.records.bytes());
    while (!reader.empty()) {
      const auto chain = reader.take<exchange::ChainHeader>();
      check_room(part.tile, chain.pixel, chain.links);
      double front = chain.front, scalar = chain.scalar_front;
      for (std::uint32_t i = 0; i < chain.links; ++i) {
        const auto link = reader.take<exchange::ChainLink>();
        if (lit) {
          const auto normal = reader.take<exchange::LinkNormal>();
          if (!projection::is_crossing(scalar))
            sent_.set(static_cast<std::uint32_t>(link.tet), {normal.x, normal.y, normal.z});
        }
        const std::size_t at = segments.size++;
        segments.pixel_and_tet[at] = link.tet << 32 | chain.pixel;
        segments.front[at] = front;
        segments.back[at] = link.back;
        segments.scalar_front[at] = cell_data && !projection::is_crossing(scalar) ? link.scalar : scalar;
        segments.scalar_back[at] = link.scalar;
        front = link.back;
        scalar = link.scalar;
      }
    }
  }

 private:
  projection::SentNormals sent_;

 protected:
  [[nodiscard]] double first_from(double depth) const override { return depth; }

  void check_room(std::uint32_t tile, std::uint32_t pixel, std::size_t more) const {
    const projection::RaySegments& segments = squares_[0].store.segments;
    if (pixel >= static_cast<std::uint32_t>(rect_.area()) || more > segments.capacity() - segments.size)
      throw malformed(tile);
  }

  /// Returns the store's segments, with room for `more` segments.
  projection::RaySegments& reserve(std::size_t more) {
    projection::RaySegments& held = squares_[0].store.segments;
    const std::size_t segments = held.size + more;
    if (segments <= held.capacity()) return held;
    constexpr std::size_t each = sorting::SegmentLists::bytes_each + integrals::SegmentBatch::bytes_each;
    const std::uint64_t budget = context_.budget_bytes;
    if (segments * each > budget || segments > std::numeric_limits<std::uint32_t>::max())
      throw scene::Error(scene::ErrorCode::system_failure,
                         fmt::format("the tile at pixel {},{} holds {} ray segments at once, beyond the memory budget; "
                                     "raise `memory` or make `tile_size` smaller",
                                     rect_.x0, rect_.y0, segments));
    held.reserve(std::min<std::size_t>(std::max(segments, 2 * held.capacity()), budget / each));
    return held;
  }
};

/// Merges the paper's tuples, whose key is only the back. Equal tuples are ordered by projector, then by arrival, which
/// is the order of cells.
class TupleMerger final : public ChainMerger {
 public:
  TupleMerger(const MergeContext& context, const scene::PixelRect& rect) : ChainMerger(context, rect, Key::back) {}

  void add(const exchange::TilePart& part) override {
    projection::RaySegments& segments = reserve(part.fragments);
    exchange::RecordReader reader(part.records.bytes());
    while (!reader.empty()) {
      const auto record = reader.take<TupleRecord>();
      check_room(part.tile, record.pixel, 1);
      // The number wraps around after 2^22 arrivals, which is more than the tuples of any one depth.
      const auto arrival = static_cast<std::uint32_t>(part.projector) << 22 | (arrivals_++ & 0x3fffff);
      projection::from_tuple(record.tuple, record.pixel, arrival, context_.longest_edge, segments, segments.size);
      ++segments.size;
    }
  }

 private:
  std::uint32_t arrivals_ = 0;
};

/// Merges lattice segments. There is one store for each square of the tile; the first segment of a square opens its
/// store, because a large tile has many squares, most of them empty at any time.
class WindowMerger final : public SegmentMerger<LatticeEncoding> {
 public:
  WindowMerger(const MergeContext& context, const scene::PixelRect& rect)
      : SegmentMerger(context, rect), places_(static_cast<std::size_t>(rect.area())) {
    const auto next = [](int v) { return (v & ~(LatticeEncoding::square - 1)) + LatticeEncoding::square; };
    for (int y = rect.y0; y < rect.y1; y = next(y))
      for (int x = rect.x0; x < rect.x1; x = next(x))
        add_square({x, y, std::min(rect.x1, next(x)), std::min(rect.y1, next(y))});
  }

  void add(const exchange::TilePart& part) override {
    const bool lit = part.kind == exchange::RecordKind::lit_lattice;
    exchange::RecordReader reader(part.records.bytes());
    while (!reader.empty()) {
      const auto header = reader.take<exchange::LatticeHeader>();
      if (header.pixel >= places_.size()) throw malformed(part.tile);
      const Place place = places_[header.pixel];
      Square& square = squares_[place.square];
      projection::SegmentWindows& windows = square.store;
      if (!square.sink) {
        windows.reset(static_cast<std::size_t>(square.rect.area()), first_capacity, lit);
        open(square);
        const std::size_t of_samples = makes_samples() ? std::max(sizeof(LatticeDeepSink), sizeof(LayerSink)) : 0;
        hold(windows.bytes() + std::max(of_samples, sizeof(PictureSink<LatticeEncoding>)), first_capacity);
      }
      for (std::uint32_t i = 0; i < header.segments; ++i) {
        const auto segment = reader.take<projection::LatticeSegment>();
        const auto light = lit ? reader.take<projection::SegmentLight>() : projection::SegmentLight{};
        while (!windows.push(place.pixel, segment, light)) grow(windows);
      }
    }
  }

 private:
  static constexpr std::size_t first_capacity = 8;  ///< segments per pixel

  /// The position of a pixel of the tile in the squares.
  struct Place {
    std::uint32_t square, pixel;
  };

  [[nodiscard]] std::int64_t first_from(double depth) const override {
    const scene::Lattice& lattice = scene_.lattice;
    const double steps = (depth - lattice.depth_origin) / lattice.depth_unit;
    if (!(std::abs(steps) < 0x1p40)) return steps > 0 ? 1LL << 40 : -(1LL << 40);
    auto step = static_cast<std::int64_t>(std::ceil(steps));
    while (lattice.depth(static_cast<double>(step - 1)) >= depth) --step;
    while (lattice.depth(static_cast<double>(step)) < depth) ++step;
    return step;
  }

  void add_square(const scene::PixelRect& rect) {
    const auto number = static_cast<std::uint32_t>(squares_.size());
    squares_.push_back({rect, {}, nullptr});
    std::uint32_t pixel = 0;
    for (int y = rect.y0; y < rect.y1; ++y)
      for (int x = rect.x0; x < rect.x1; ++x)
        places_[static_cast<std::size_t>(y - rect_.y0) * static_cast<std::size_t>(rect_.width()) +
                static_cast<std::size_t>(x - rect_.x0)] = {number, pixel++};
  }

  void grow(projection::SegmentWindows& windows) {
    const std::size_t grown = windows.bytes_after_growth(), more = grown - windows.bytes();
    hold(grown > windows.most_bytes ? context_.budget_bytes + 1 : more, windows.capacity());
    windows.grow();
  }

  void hold(std::uint64_t more_bytes, std::size_t capacity) {
    bytes_ += more_bytes;
    if (bytes_ <= context_.budget_bytes) return;
    throw scene::Error(
        scene::ErrorCode::system_failure,
        fmt::format("the tile at pixel {},{} holds more than {} ray segments of a pixel at once, beyond the memory "
                    "budget; raise `memory` or make `tile_size` smaller",
                    rect_.x0, rect_.y0, capacity));
  }

  std::vector<Place> places_;
  std::uint64_t bytes_ = 0;
};

}  // namespace

std::unique_ptr<TileMerger> make_tuple_merger(const MergeContext& context, const scene::PixelRect& rect) {
  return std::make_unique<TupleMerger>(context, rect);
}

std::unique_ptr<TileMerger> make_segment_merger(const MergeContext& context, const scene::PixelRect& rect) {
  return std::make_unique<ChainMerger>(context, rect);
}

std::unique_ptr<TileMerger> make_window_merger(const MergeContext& context, const scene::PixelRect& rect) {
  if (context.lattice == nullptr || context.table == nullptr)
    throw scene::Error(scene::ErrorCode::system_failure,
                       "exchange: received lattice segments without a lattice; all ranks must run the same program");
  return std::make_unique<WindowMerger>(context, rect);
}

}  // namespace tessera::compositor
