// SPDX-License-Identifier: BSD-3-Clause
#include "compositor/gl/gl_merger.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <future>
#include <limits>
#include <memory>
#include <utility>
#include <vector>

#include "compositor/gl/gl_compositor.hpp"
#include "compositor/gl/gl_fallback.hpp"
#include "compositor/merge_kinds.hpp"
#include "compositor/merged_pixel.hpp"
#include "compositor/tuple_record.hpp"
#include "compositor/window_kernel.hpp"
#include "projection/scanline/segment_tuple.hpp"

namespace tessera::compositor {
namespace {

/// Final fragments of a tile go to the device only when at least this number of its fragments is waiting, or when the
/// tile is complete.
constexpr std::size_t patient_fragments = 1 << 20;
constexpr double infinity = std::numeric_limits<double>::infinity();

/// Returns a float's bits as an integer with the same order.
std::uint32_t ordered(float x) {
  const auto bits = std::bit_cast<std::uint32_t>(x);
  return (bits & 0x80000000u) != 0 ? ~bits : bits | 0x80000000u;
}

/// Returns a scalar in the table's units. In the range of the transfer function's knots, it is the result of
/// lane_scalar(), so that a value at a step of the function stays at the step. Outside that range, rounding to whole
/// units has no benefit, and the scalar is not rounded.
float device_scalar(double value, const scene::Lattice& units) {
  const double n = (value - units.scalar_origin) / units.scalar_unit;
  return std::abs(n) < scene::Lattice::limit ? integrals::lane_scalar(value, units.scalar_origin, units.scalar_unit)
                                             : static_cast<float>(n);
}

class GlMerger final : public TileMerger {
 public:
  GlMerger(const MergeContext& context, const scene::PixelRect& rect)
      : context_(context),
        units_(*context.lattice),
        rect_(rect),
        weight_(integrals::opacity_weight(context.max_color, context.longest_ray, context.emission)),
        rules_{context.table, context.frame, context.integrator->samples(),
               static_cast<float>(context.integrator->termination_error() / weight_)},
        pixels_(static_cast<std::size_t>(rect.area())) {
    length_.reserve(pixels_.size());
    for (int y = rect.y0; y < rect.y1; ++y)
      for (int x = rect.x0; x < rect.x1; ++x) length_.push_back(context.space->length_per_depth(x + 0.5, y + 0.5));
  }

  void add(const exchange::TilePart& part) override {
    reserve(fragments_.size() + part.fragments);
    exchange::RecordReader reader(part.records.bytes());
    if (part.kind == exchange::RecordKind::cells) {
      const std::size_t count = part.records.size() / sizeof(projection::CellRecord);
      const std::size_t all = cells_->records.size() + count;
      if (all * sizeof(projection::CellRecord) > context_.budget_bytes) refuse(all, "cells");
      reader.take_onto(cells_->records, count);
      return;
    }
    while (!reader.empty()) switch (part.kind) {
        case exchange::RecordKind::lattice: {
          const auto header = reader.take<exchange::LatticeHeader>();
          check(part, header.pixel);
          for (std::uint32_t i = 0; i < header.segments; ++i)
            add(header.pixel, reader.take<projection::LatticeSegment>());
          break;
        }
        case exchange::RecordKind::lattice_runs: {
          const auto header = reader.take<exchange::RunsHeader>();
          check(part, header.pixel);
          for (int i = 0; i < header.runs; ++i) {
            const auto run = reader.take<exchange::LatticeRun>();
            push({double(run.front),
                  double(run.back),
                  {run.red, run.green, run.blue, optical_depth_of(run.opacity)},
                  header.pixel,
                  ordered(run.opacity),
                  0});
          }
          for (int i = 0; i < header.segments; ++i) add(header.pixel, reader.take<projection::LatticeSegment>());
          break;
        }
        case exchange::RecordKind::runs: {
          const auto run = reader.take<exchange::RunRecord>();
          check(part, run.pixel);
          push({run.front,
                run.front + run.thickness,
                {run.red, run.green, run.blue, optical_depth_of(run.opacity)},
                run.pixel,
                ordered(run.opacity)});
          break;
        }
        case exchange::RecordKind::chains:
        case exchange::RecordKind::chains_of_cells:
          add_chain(part, reader);
          break;
        case exchange::RecordKind::cells:
        case exchange::RecordKind::pixels:
        case exchange::RecordKind::lit_chains:
        case exchange::RecordKind::lit_lattice:  // devices do not light matter
          throw scene::Error(scene::ErrorCode::system_failure,
                             "exchange: received records that no device supports; all ranks must run the same program");
        case exchange::RecordKind::tuples: {
          const auto record = reader.take<TupleRecord>();
          check(part, record.pixel);
          by_back_ = true;
          const auto [front, back] =
              projection::depths_of(record.tuple.z_back, record.tuple.length, context_.longest_edge);
          // As in TupleMerger, equal tuples are ordered by projector, then by arrival.
          add(record.pixel, front, back, record.tuple.scalar_front, record.tuple.scalar_back,
              static_cast<std::uint32_t>(part.projector) << 22 | (arrivals_++ & 0x3fffff));
          break;
        }
      }
    integrate_batch();
  }

  void advance(double final_depth) override {
    const bool all = std::isinf(final_depth) && final_depth > 0;
    if (!all && !cells_->records.empty()) return;  // segments of cells are not known before the device rasterizes
    if (!all && fragments_.size() < patient_fragments &&
        fragments_.size() * sizeof(Fragment) < context_.budget_bytes / 2)
      return;
    const double final_step = on_lattice() ? (final_depth - units_.depth_origin) / units_.depth_unit : final_depth;
    const auto rest = std::partition(fragments_.begin(), fragments_.end(), [&](const Fragment& fragment) {
      return all || (by_back_ ? fragment.back : fragment.front) < final_step;
    });
    try {
      composite({fragments_.begin(), rest});
      fragments_.erase(fragments_.begin(), rest);
    } catch (const scene::Error&) {
      if (context_.device_failed == nullptr || cells_->records.empty()) throw;
      *context_.device_failed = true;
      rasterize_here();
      composite(fragments_);
      fragments_.clear();
    }
    if (!cells_->records.empty()) cells_ = std::make_shared<GlCells>();  // the device may still use the previous cells
  }

  MergedTile finish() override { return {image_of(pixels_, {rect_.width(), rect_.height()}), {}, {}}; }

 private:
  struct Fragment {
    double front, back;          ///< in steps of the lattice, or planar depth
    std::array<float, 4> value;  ///< GlFragments
    std::uint32_t pixel, tie;
    float along = 0;  ///< for the light of a run: where it begins, from 0 at the front to 1 at the back
  };

  [[nodiscard]] bool on_lattice() const { return context_.on_lattice; }
  /// Whether segments are integrated here, in double precision; the device then only sorts and composites their light.
  /// This is necessary for `exact` if a very steep or opaque transfer function does not allow a lattice: the device's
  /// floats are then not accurate enough.
  [[nodiscard]] bool integrates_here() const {
    return !on_lattice() && rules_.samples == 0 && context_.device->method() == GlMethod::compute;
  }

  void check(const exchange::TilePart& part, std::uint32_t pixel) const {
    if (pixel < pixels_.size()) return;
    throw scene::Error(scene::ErrorCode::system_failure,
                       fmt::format("exchange: the fragments of tile {} are malformed; all ranks must run the same "
                                   "program",
                                   part.tile));
  }

  void reserve(std::size_t count) {
    if (count * sizeof(Fragment) > context_.budget_bytes || count > std::numeric_limits<std::uint32_t>::max())
      refuse(count, "fragments");
  }
  [[noreturn]] void refuse(std::uint64_t count, const char* what) const {
    throw scene::Error(scene::ErrorCode::system_failure,
                       fmt::format("the tile at pixel {},{} holds {} {} at once, beyond the memory budget; raise "
                                   "`memory` or make `tile_size` smaller",
                                   rect_.x0, rect_.y0, count, what));
  }

  void push(const Fragment& fragment) {
    if (pixels_[fragment.pixel].open) fragments_.push_back(fragment);
  }

  void add(std::uint32_t pixel, const projection::LatticeSegment& s) {
    const float length = static_cast<float>(s.back - s.front) * static_cast<float>(length_[pixel]);
    push(
        {double(s.front), double(s.back), {length, s.scalar_front, s.scalar_back, -1}, pixel, ordered(s.scalar_front)});
  }

  void add(std::uint32_t pixel, double front, double back, double scalar_front, double scalar_back, std::uint32_t tie) {
    if (!pixels_[pixel].open) return;
    Fragment fragment{front, back, {}, pixel, tie, 0};
    if (integrates_here()) {
      const std::size_t i = batch_.size++;
      batch_.reserve(std::max(batch_.size, 2 * i));
      batch_.length[i] = (back - front) * length_[pixel];
      batch_.scalar_front[i] = scalar_front;
      batch_.scalar_back[i] = scalar_back;
    } else {
      fragment.value = {static_cast<float>((back - front) * length_[pixel] / units_.depth_unit),
                        device_scalar(scalar_front, units_), device_scalar(scalar_back, units_), -1};
    }
    fragments_.push_back(fragment);
  }

  /// Replaces the values of the last fragments by the light of the batch.
  void integrate_batch() {
    if (batch_.size == 0) return;
    context_.integrator->integrate(batch_);
    const std::size_t first = fragments_.size() - batch_.size;
    for (std::size_t i = 0; i < batch_.size; ++i) {
      Fragment& fragment = fragments_[first + i];
      fragment.value = {static_cast<float>(batch_.red[i]), static_cast<float>(batch_.green[i]),
                        static_cast<float>(batch_.blue[i]), static_cast<float>(batch_.optical_depth[i])};
      if (batch_.optical_depth[i] > 0)
        fragment.along = static_cast<float>(
            context_.integrator->first_visible(batch_.scalar_front[i], batch_.scalar_back[i]).value_or(0));
    }
    batch_.size = 0;
  }

  void add_chain(const exchange::TilePart& part, exchange::RecordReader& reader) {
    const bool cell_data = part.kind == exchange::RecordKind::chains_of_cells;
    const auto chain = reader.take<exchange::ChainHeader>();
    check(part, chain.pixel);
    double front = chain.front, scalar = chain.scalar_front;
    for (std::uint32_t i = 0; i < chain.links; ++i) {
      const auto link = reader.take<exchange::ChainLink>();
      add(chain.pixel, front, link.back, cell_data ? link.scalar : scalar, link.scalar,
          static_cast<std::uint32_t>(link.tet));
      front = link.back;
      scalar = link.scalar;
    }
  }

  /// Converts depths to 32-bit integers: on the lattice, in the lattice's steps; otherwise, in the finest power-of-two
  /// steps that span all depths.
  struct Steps {
    double origin = 0, per_unit = 1;
    [[nodiscard]] std::uint32_t of(double depth) const {
      return static_cast<std::uint32_t>(std::min((depth - origin) * per_unit, 4294967294.0));
    }
  };
  [[nodiscard]] Steps steps_of(std::span<const Fragment> fragments) const {
    double low = infinity, high = -low;
    for (const Fragment& f : fragments) low = std::min(low, f.front), high = std::max(high, f.back);
    for (const projection::CellRecord& cell : cells_->records)
      for (const auto& corner : cell.corner) {
        const double depth = on_lattice() ? (corner.depth - units_.depth_origin) / units_.depth_unit : corner.depth;
        low = std::min(low, depth), high = std::max(high, depth);
      }
    if (!(high > low)) return {low, 1};
    return {low, std::exp2(std::floor(std::log2(4294967295.0 / (high - low))))};
  }

  /// The fragments, and the cells' segments, of each pixel.
  struct ByPixel {
    std::vector<std::uint32_t> order;  ///< indices of fragments
    /// The fragments of pixel p are order[begin_given[p]] to order[begin_given[p + 1]].
    std::vector<std::uint32_t> begin_given;
    std::vector<std::uint32_t> begin;  ///< the same, but including the cells' segments, which follow the fragments
    Steps steps;
    [[nodiscard]] std::uint32_t count(std::size_t p) const { return begin[p + 1] - begin[p]; }
    [[nodiscard]] std::uint32_t given(std::size_t p) const { return begin_given[p + 1] - begin_given[p]; }
  };

  ByPixel by_pixel(std::span<const Fragment> fragments) const {
    ByPixel by{std::vector<std::uint32_t>(fragments.size()),
               std::vector<std::uint32_t>(pixels_.size() + 1, 0),
               {},
               steps_of(fragments)};
    for (const Fragment& f : fragments) ++by.begin_given[f.pixel + 1];
    for (std::size_t p = 0; p < pixels_.size(); ++p) by.begin_given[p + 1] += by.begin_given[p];
    std::vector<std::uint32_t> next(by.begin_given.begin(), by.begin_given.end() - 1);
    for (std::size_t i = 0; i < fragments.size(); ++i)
      by.order[next[fragments[i].pixel]++] = static_cast<std::uint32_t>(i);
    by.begin = by.begin_given;
    if (cells_->records.empty()) return by;
    cells_->units = cell_units(by.steps);
    const std::vector<std::uint32_t> counts = answer_of(context_.device->count(cells_, rect_, context_.frame));
    std::uint64_t before = 0;
    for (std::size_t p = 0; p < pixels_.size(); ++p) by.begin[p + 1] += static_cast<std::uint32_t>(before += counts[p]);
    if (by.begin_given.back() + before > std::numeric_limits<std::uint32_t>::max()) refuse(before, "ray segments");
    return by;
  }

  [[nodiscard]] projection::CellUnits cell_units(const Steps& steps) const {
    const scene::ImageSize size = context_.space->size();
    projection::CellUnits units{0.5 * size.width, 0.5 * size.height, context_.space->pixels_per_tangent(),
                                units_,           steps.origin,      steps.per_unit};
    if (on_lattice()) {
      units.key_origin = units_.depth(steps.origin);
      units.keys_per_depth = steps.per_unit / units_.depth_unit;
    }
    return units;
  }

  template <class Answer>
  Answer answer_of(std::future<Answer> future) const {
    const scene::TraceScope timing(context_.trace, "wait", static_cast<std::int32_t>(context_.frame));
    return future.get();
  }

  /// The pixels of a job.
  struct Portion {
    std::size_t first_pixel, end_pixel;
    std::future<std::vector<GlLight>> future;
    std::vector<GlLight> lights{};
  };

  void composite(std::span<const Fragment> fragments) {
    if (fragments.empty() && cells_->records.empty()) return;
    const ByPixel by = by_pixel(fragments);
    std::vector<Portion> portions;
    for (std::size_t p = 0; p < pixels_.size();) {
      const std::size_t first = p;
      p = portion_end(by, first);
      if (by.begin[p] == by.begin[first]) continue;
      portions.push_back({first, p, context_.device->composite(portion(fragments, by, first, p), rules_)});
    }
    // Wait for all lights before one is used: if the device fails, the tile's cells are rasterized here.
    for (Portion& portion : portions) portion.lights = lights_of(portion, fragments, by);
    count(by.begin.back() - by.begin_given.back());
    for (const Portion& portion : portions) {
      std::size_t list = 0;
      for (std::size_t p = portion.first_pixel; p < portion.end_pixel; ++p) {
        if (by.count(p) == 0) continue;
        const GlLight& light = portion.lights[list++];
        if (light.first == GlLight::no_fragment)
          add_light(light, infinity, pixels_[p]);
        else if (light.first == GlLight::rasterized_one)
          add_light(light, visible_depth(light, by.steps), pixels_[p]);
        else
          add_light(
              light,
              visible_depth(
                  fragments[by.order[by.begin_given[p] + light.first - (by.begin[p] - by.begin[portion.first_pixel])]]),
              pixels_[p]);
      }
    }
  }

  /// Returns the end of a portion that begins at `first`: whole rows of pixels, as many as comfortable_fragments()
  /// allows. If the device fills lists and one row is too large, returns the end of as many pixels of this row as are
  /// allowed.
  [[nodiscard]] std::size_t portion_end(const ByPixel& by, std::size_t first) const {
    const auto width = static_cast<std::size_t>(rect_.width());
    const std::size_t row_end = first - first % width + width;
    const auto fits = [&](std::size_t end) {
      return by.begin[end] - by.begin[first] <= context_.device->comfortable_fragments();
    };
    const bool in_row = !cells_->records.empty() && (first % width != 0 || !fits(row_end));
    const std::size_t last = in_row ? row_end : pixels_.size(), step = in_row ? 1 : width;
    std::size_t end = first + step;
    while (end < last && fits(end + step)) end += step;
    return end;
  }

  std::vector<GlLight> lights_of(Portion& portion, std::span<const Fragment> fragments, const ByPixel& by) const {
    try {
      return answer_of(std::move(portion.future));
    } catch (const scene::Error&) {
      if (context_.device_failed == nullptr || !cells_->records.empty()) throw;
      *context_.device_failed = true;
      const GlFragments again = this->portion(fragments, by, portion.first_pixel, portion.end_pixel);
      return composite_on_cpu(again, rules_, *context_.integrator, units_);
    }
  }

  GlFragments portion(std::span<const Fragment> fragments, const ByPixel& by, std::size_t first,
                      std::size_t end) const {
    GlFragments out;
    out.width = rect_.width();
    const std::size_t given = by.begin_given[end] - by.begin_given[first];
    out.keys.reserve(given);
    out.values.reserve(given);
    for (std::size_t p = first; p < end; ++p) {
      if (by.count(p) == 0) continue;
      std::uint32_t element = by.begin[p] - by.begin[first];
      out.lists.push_back({static_cast<std::uint32_t>(p), element, by.count(p), by.count(p) - by.given(p)});
      for (std::uint32_t i = by.begin_given[p]; i < by.begin_given[p + 1]; ++i) {
        const Fragment& f = fragments[by.order[i]];
        // With Key::back, fragments are not ordered by their fronts.
        out.keys.push_back(
            {by_back_ ? by.steps.of(f.back) : by.steps.of(f.front), by.steps.of(f.back), f.tie, element++});
        out.values.push_back(f.value);
      }
    }
    if (by.begin[end] - by.begin[first] == given) return out;
    const int width = rect_.width(), y = rect_.y0 + static_cast<int>(first) / width,
              x = rect_.x0 + static_cast<int>(first) % width, pixels = static_cast<int>(end - first);
    out.cells = cells_;
    out.rect = pixels < width ? scene::PixelRect{x, y, x + pixels, y + 1}
                              : scene::PixelRect{rect_.x0, y, rect_.x1, y + pixels / width};
    out.first_pixel = static_cast<std::uint32_t>(first);
    return out;
  }

  /// Turns the cells' segments into ordinary fragments because the device has failed.
  void rasterize_here() {
    const std::shared_ptr<const GlCells> from = std::exchange(cells_, std::make_shared<GlCells>());
    projection::rasterize_records(
        from->records, rect_, context_.space->pixels_per_tangent(),
        [&](const projection::RaySegments& segments, std::span<const projection::CellRecord> cells) {
          reserve(fragments_.size() + segments.size);
          count(segments.size);
          const auto in_units = [&](double depth) {
            return on_lattice() ? (depth - units_.depth_origin) / units_.depth_unit : depth;
          };
          for (std::size_t i = 0; i < segments.size; ++i) {
            const std::uint32_t pixel = segments.pixel(i);
            const double length = (segments.back[i] - segments.front[i]) * length_[pixel] / units_.depth_unit;
            push({in_units(segments.front[i]),
                  in_units(segments.back[i]),
                  {static_cast<float>(length), device_scalar(segments.scalar_front[i], units_),
                   device_scalar(segments.scalar_back[i], units_), -1},
                  pixel,
                  static_cast<std::uint32_t>(cells[segments.tet(i)].tet)});
          }
        });
  }

  /// Counts segments of cells; no projector has counted them.
  void count(std::uint64_t segments) const {
    if (context_.segments != nullptr) *context_.segments += segments;
  }

  /// Adds light; all of it is behind the pixel's present contents.
  void add_light(const GlLight& light, double first_depth, MergedPixel& pixel) const {
    if (!pixel.open) return;
    if (std::isinf(pixel.first_depth)) pixel.first_depth = first_depth;
    pixel.add(light.red, light.green, light.blue, -std::expm1(-double{light.optical_depth}));
    pixel.open = (1 - pixel.opacity) * weight_ >= context_.integrator->termination_error();
  }

  /// The depth at which a GlLight::rasterized_one becomes visible.
  [[nodiscard]] double visible_depth(const GlLight& light, const Steps& steps) const {
    const double along = light.along;
    const double at = steps.origin + ((1 - along) * light.front + along * light.back) / steps.per_unit;
    return on_lattice() ? units_.depth(at) : at;
  }

  [[nodiscard]] double visible_depth(const Fragment& f) const {
    const auto depth = [&](double at) { return on_lattice() ? units_.depth(at) : at; };
    if (f.value[3] >= 0) return depth(f.front) + (depth(f.back) - depth(f.front)) * f.along;
    const auto scalar = [&](float at) { return units_.scalar(double{at}); };
    const double along = context_.integrator->first_visible(scalar(f.value[1]), scalar(f.value[2])).value_or(0);
    return depth(f.front) + (depth(f.back) - depth(f.front)) * along;
  }

  MergeContext context_;
  scene::Lattice units_;
  scene::PixelRect rect_;
  double weight_;
  GlRules rules_;
  std::vector<MergedPixel> pixels_;
  std::vector<double> length_;  ///< for each pixel, world length per unit of planar depth
  std::vector<Fragment> fragments_;
  /// Cells, which wait until all other parts of the tile have arrived.
  std::shared_ptr<GlCells> cells_ = std::make_shared<GlCells>();
  integrals::SegmentBatch batch_;
  bool by_back_ = false;
  std::uint32_t arrivals_ = 0;
};

}  // namespace

scene::Lattice device_units(const scene::TransferFunction& function, double longest_ray) {
  using scene::Lattice;
  const double low = function.knots().front().value, high = function.knots().back().value;
  Lattice units{};
  units.depth_unit = longest_ray > 0 ? std::exp2(std::ceil(std::log2(longest_ray))) : 1;
  units.scalar_origin = low + (high - low) / 2;
  units.scalar_unit = Lattice::unit_for(std::max((high - low) / 2, 1e-12 * std::abs(units.scalar_origin)));
  return units;
}

std::unique_ptr<TileMerger> make_gl_merger(const MergeContext& context, const scene::PixelRect& rect) {
  return std::make_unique<GlMerger>(context, rect);
}

}  // namespace tessera::compositor
