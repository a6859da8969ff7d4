#include <fmt/format.h>

#include <cmath>
#include <memory>
#include <vector>

#include "compositor/merge_kinds.hpp"
#include "compositor/window_pixels.hpp"

namespace tessera::compositor {
namespace {

constexpr int side = projection::SegmentWindows::side;
constexpr std::size_t first_capacity = 8;  // segments a pixel

/// Lattice segments: windowed, sorted and integrated by the code that does it for a single process.
class WindowMerger final : public TileMerger {
 public:
  WindowMerger(const MergeContext& context, const scene::PixelRect& rect)
      : trace_(context.trace),
        budget_(context.budget_bytes),
        rect_(rect),
        lattice_(*context.lattice),
        scene_{context.space, context.table, context.integrator, lattice_,
               integrals::opacity_weight(context.max_color, context.longest_ray, context.emission)},
        image_({rect.width(), rect.height()}),
        places_(static_cast<std::size_t>(rect.area())) {
    const auto next = [](int v) { return (v & ~(side - 1)) + side; };
    for (int y = rect.y0; y < rect.y1; y = next(y))
      for (int x = rect.x0; x < rect.x1; x = next(x))
        add_square({x, y, std::min(rect.x1, next(x)), std::min(rect.y1, next(y))});
  }

  void add(const exchange::TilePart& part) override {
    exchange::RecordReader reader(part.records.bytes());
    while (!reader.empty()) {
      const auto header = reader.take<exchange::LatticeHeader>();
      if (header.pixel >= places_.size())
        throw scene::Error(scene::ErrorCode::system_failure,
                           fmt::format("exchange: the segments of tile {} are malformed; all ranks must run the same "
                                       "program",
                                       part.tile));
      const Place place = places_[header.pixel];
      Square& square = squares_[place.square];
      if (!square.pixels) open(square);
      projection::SegmentWindows& windows = square.windows;
      for (std::uint32_t i = 0; i < header.segments; ++i) {
        const auto segment = reader.take<projection::LatticeSegment>();
        while (!windows.push(place.pixel, segment)) grow(windows);
      }
    }
  }

  void advance(double final_depth) override {
    const std::int64_t step = step_at(final_depth);
    scene::TraceLaps laps(trace_);
    for (Square& square : squares_)
      if (square.pixels) square.pixels->take(square.windows, step, 1, laps);
  }

  MergedTile finish() override {
    for (Square& square : squares_)
      if (square.pixels) square.pixels->finish();
    return {std::move(image_), {}, {}};
  }

 private:
  /// Opened by its first segment: a large tile has many, most of them empty at any time.
  struct Square {
    scene::PixelRect rect;
    projection::SegmentWindows windows;
    std::unique_ptr<WindowPixels> pixels;
  };
  /// Where a pixel of the tile is.
  struct Place {
    std::uint32_t square, pixel;
  };

  void add_square(const scene::PixelRect& rect) {
    const auto number = static_cast<std::uint32_t>(squares_.size());
    squares_.push_back({rect, {}, nullptr});
    std::uint32_t pixel = 0;
    for (int y = rect.y0; y < rect.y1; ++y)
      for (int x = rect.x0; x < rect.x1; ++x)
        places_[static_cast<std::size_t>(y - rect_.y0) * static_cast<std::size_t>(rect_.width()) +
                static_cast<std::size_t>(x - rect_.x0)] = {number, pixel++};
  }

  void open(Square& square) {
    square.windows.reset(static_cast<std::size_t>(square.rect.area()), first_capacity);
    square.pixels = std::make_unique<WindowPixels>(scene_, ImageWindow{&image_, rect_.x0, rect_.y0});
    square.pixels->start(square.rect);
    hold(square.windows.bytes() + sizeof(WindowPixels), first_capacity);
  }

  void grow(projection::SegmentWindows& windows) {
    const std::size_t grown = windows.bytes_after_growth(), more = grown - windows.bytes();
    hold(grown > windows.most_bytes ? budget_ + 1 : more, windows.capacity());
    windows.grow();
  }

  void hold(std::uint64_t more_bytes, std::size_t capacity) {
    bytes_ += more_bytes;
    if (bytes_ <= budget_) return;
    throw scene::Error(
        scene::ErrorCode::system_failure,
        fmt::format("the tile at pixel {},{} holds more than {} ray segments of a pixel at once, beyond the memory "
                    "budget; raise `memory` or make `tile_size` smaller",
                    rect_.x0, rect_.y0, capacity));
  }

  /// The first step that does not lie before `depth`.
  [[nodiscard]] std::int64_t step_at(double depth) const {
    const double steps = (depth - lattice_.depth_origin) / lattice_.depth_unit;
    if (!(std::abs(steps) < 0x1p40)) return steps > 0 ? 1LL << 40 : -(1LL << 40);
    auto step = static_cast<std::int64_t>(std::ceil(steps));
    while (lattice_.depth(static_cast<double>(step - 1)) >= depth) --step;
    while (lattice_.depth(static_cast<double>(step)) < depth) ++step;
    return step;
  }

  scene::Trace* trace_;
  std::uint64_t budget_, bytes_ = 0;
  scene::PixelRect rect_;
  scene::Lattice lattice_;
  WindowScene scene_;
  scene::Image image_;
  std::vector<Place> places_;
  std::vector<Square> squares_;
};

}  // namespace

std::unique_ptr<TileMerger> make_window_merger(const MergeContext& context, const scene::PixelRect& rect) {
  if (context.lattice == nullptr || context.table == nullptr)
    throw scene::Error(scene::ErrorCode::system_failure,
                       "exchange: lattice segments without a lattice; all ranks must run the same program");
  return std::make_unique<WindowMerger>(context, rect);
}

}  // namespace tessera::compositor
