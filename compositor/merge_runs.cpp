// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <tuple>
#include <utility>
#include <vector>

#include "compositor/merge_kinds.hpp"
#include "compositor/merged_pixel.hpp"
#include "compositor/window_kernel.hpp"
#include "integrals/integrate_lanes.hpp"
#include "projection/surface_crossings.hpp"

namespace tessera::compositor {
namespace {

/// Merges runs and composites them front to back. A pixel has few runs.
class RunMerger final : public TileMerger {
 public:
  RunMerger(const MergeContext& context, const scene::PixelRect& rect)
      : context_(context),
        budget_(context.budget_bytes),
        rect_(rect),
        weight_(context.opacity_weight()),
        termination_error_(context.integrator->termination_error()),
        first_of_(static_cast<std::size_t>(rect.area()), none) {}

  void add(const exchange::TilePart& part) override {
    const std::uint64_t held = runs_.size() + in_streams_;
    if ((held + part.fragments) * sizeof(Run) > budget_)
      throw scene::Error(scene::ErrorCode::system_failure,
                         fmt::format("the tile at pixel {},{} holds {} runs at once, beyond the memory budget; raise "
                                     "`memory` or make `tile_size` smaller",
                                     rect_.x0, rect_.y0, held + part.fragments));
    if (part.kind == exchange::RecordKind::runs) {
      exchange::RecordReader reader(part.records.bytes());
      while (!reader.empty()) {
        const auto run = reader.take<exchange::RunRecord>();
        if (run.pixel >= first_of_.size()) refuse(part.tile);
        push(run.pixel, {run.front, run.thickness, run.red, run.green, run.blue, run.opacity});
      }
      return;
    }
    if (context_.lattice == nullptr || context_.table == nullptr)
      throw scene::Error(
          scene::ErrorCode::system_failure,
          "exchange: received runs on a lattice that does not exist; all ranks must run the same program");
    if (part.segments || !part.ascending) push_records(part, !part.ascending);
    if (!part.ascending) return;
    streams_.emplace_back(part);
    in_streams_ += part.fragments;
  }

  void advance(double final_depth) override {
    const bool all = final_depth == std::numeric_limits<double>::infinity();
    if (!all) {
      // A stream cannot keep the runs behind `final_depth` for later, so the runs of all streams are stored in `runs_`.
      for (const Stream& stream : streams_) push_runs(stream);
      streams_.clear();
      in_streams_ = 0;
      if (runs_.empty()) return;
      if (pixels_.empty()) pixels_.resize(first_of_.size());
    } else {
      image_ = scene::Image({rect_.width(), rect_.height()});
    }
    const std::vector<Run> runs = std::exchange(runs_, {});
    for (std::uint32_t p = 0; p < first_of_.size(); ++p) {
      here_.clear();
      for (std::uint32_t i = std::exchange(first_of_[p], none); i != none; i = runs[i].next) here_.push_back(runs[i]);
      for (Stream& stream : streams_)
        if (stream.header.pixel == p) take_here(stream);
      if (here_.empty() && (!all || pixels_.empty())) continue;
      Pixel pixel = pixels_.empty() ? Pixel{} : pixels_[p];
      for (std::size_t left = composite(final_depth, pixel); left < here_.size(); ++left) push(p, here_[left]);
      if (all)
        pixel.write(image_, p);
      else
        pixels_[p] = pixel;
    }
    for (const Stream& stream : streams_)
      if (stream.header.pixel != none) refuse(stream.tile);
  }

  MergedTile finish() override { return {std::move(image_), {}, {}}; }

 private:
  static constexpr std::uint32_t none = 0xffffffff;

  /// A RunRecord, and the index of the previous run of its pixel.
  struct Run {
    double front;
    float thickness, red, green, blue, opacity;
    std::uint32_t next = none;
  };

  /// A pixel with the composited runs, and the end of the farthest of these runs.
  struct Pixel : MergedPixel {
    double reach = -std::numeric_limits<double>::infinity();
    float opacity_to_reach = 0;
  };

  /// An ascending part, which is read pixel by pixel, in parallel with other parts. The stream skips single segments,
  /// which push_records() reads.
  struct Stream {
    explicit Stream(const exchange::TilePart& part)
        : records(part.records), reader(records.bytes()), tile(part.tile), segments(part.segments) {
      read_header();
    }
    /// At the end, the header's pixel is `none`.
    void read_header() {
      const std::uint32_t before = std::exchange(header, {none, 0, 0}).pixel;
      if (reader.empty()) return;
      header = reader.take<exchange::RunsHeader>();
      if (header.pixel == none || (before != none && header.pixel <= before)) refuse(tile);
      if (header.segments != 0 && !segments) refuse(tile);
    }
    exchange::Records records;  ///< keeps the bytes in memory
    exchange::RecordReader reader;
    std::uint32_t tile;
    bool segments;
    exchange::RunsHeader header{none, 0, 0};
  };

  [[noreturn]] static void refuse(std::uint32_t tile) {
    throw scene::Error(
        scene::ErrorCode::system_failure,
        fmt::format("exchange: the runs of tile {} are malformed; all ranks must run the same program", tile));
  }

  void push(std::uint32_t pixel, Run run) {
    run.next = std::exchange(first_of_[pixel], static_cast<std::uint32_t>(runs_.size()));
    runs_.push_back(run);
  }

  [[nodiscard]] Run world_run(const exchange::LatticeRun& run) const {
    const double front = context_.lattice->depth(run.front);
    return {front,      static_cast<float>(context_.lattice->depth(run.back) - front), run.red, run.green, run.blue,
            run.opacity};
  }

  /// Stores a part's single segments and, if `runs` is set, its other runs too.
  void push_records(const exchange::TilePart& part, bool runs) {
    exchange::RecordReader reader(part.records.bytes());
    single_.clear();
    while (!reader.empty()) {
      const auto header = reader.take<exchange::RunsHeader>();
      if (header.pixel >= first_of_.size()) refuse(part.tile);
      if (!runs) reader.take_bytes(header.runs * sizeof(exchange::LatticeRun));
      for (int i = 0; runs && i < header.runs; ++i) push(header.pixel, world_run(reader.take<exchange::LatticeRun>()));
      for (int i = 0; i < header.segments; ++i)
        single_.push_back({header.pixel, reader.take<projection::LatticeSegment>()});
    }
    integrate_single();
  }

  void push_runs(Stream stream) {
    for (; stream.header.pixel < first_of_.size(); stream.read_header()) {
      for (int i = 0; i < stream.header.runs; ++i)
        push(stream.header.pixel, world_run(stream.reader.take<exchange::LatticeRun>()));
      stream.reader.take_bytes(stream.header.segments * sizeof(projection::LatticeSegment));
    }
    if (stream.header.pixel != none) refuse(stream.tile);
  }

  void take_here(Stream& stream) {
    for (int i = 0; i < stream.header.runs; ++i) here_.push_back(world_run(stream.reader.take<exchange::LatticeRun>()));
    stream.reader.take_bytes(stream.header.segments * sizeof(projection::LatticeSegment));
    stream.read_header();
  }

  /// Composites the pixel's runs before `final_depth`, front to back. Leaves all runs sorted, and returns the index of
  /// the first run that is not composited.
  std::size_t composite(double final_depth, Pixel& pixel) {
    // Runs are compared by all fields: equal runs are interchangeable, so the order of arrival has no effect.
    const auto before = [](const Run& a, const Run& b) {
      if (a.front != b.front) return a.front < b.front;
      const auto key = [](const Run& run) {
        return std::tie(run.thickness, run.opacity, run.red, run.green, run.blue);
      };
      return key(a) < key(b);
    };
    if (here_.size() == 2) {
      if (before(here_[1], here_[0])) std::swap(here_[0], here_[1]);
    } else if (here_.size() > 2) {
      std::sort(here_.begin(), here_.end(), before);
    }
    std::size_t at = 0;
    for (; at < here_.size() && here_[at].front < final_depth; ++at) {
      const Run& run = here_[at];
      if (!pixel.open) continue;
      note_overlap(run, pixel);
      if (run.opacity > 0) pixel.first_depth = std::min(pixel.first_depth, run.front);
      pixel.add(run.red, run.green, run.blue, run.opacity);
      pixel.open = (1 - pixel.opacity) * weight_ >= termination_error_;
    }
    return at;
  }

  /// Records that cells overlap if this run begins before the previous run ends. Neither order of the two runs is then
  /// correct. A wrong order changes a pixel by at most the product of the runs' opacities.
  void note_overlap(const Run& run, Pixel& pixel) const {
    constexpr double negligible = 1e-7, rounding = 0x1p-20;
    // On the lattice, the back of one run and the front of the next may differ by some steps, although their cells
    // share a face, if one of the cells was projected in double precision.
    const double steps =
        context_.lattice != nullptr ? 2 * projection::back_end_steps * context_.lattice->depth_unit : 0;
    const double within = steps + rounding * run.thickness + 0x1p-40 * std::abs(run.front);
    const double back = run.front + run.thickness - within;  // lower bound of the end
    if (run.front < pixel.reach && run.front < back && run.opacity * pixel.opacity_to_reach * weight_ > negligible &&
        context_.overlapping != nullptr)
      *context_.overlapping = true;
    if (back > pixel.reach) pixel.reach = back, pixel.opacity_to_reach = run.opacity;
  }

  /// Integrates runs that consist of one segment. The result has the same bits as if the projector had integrated them.
  void integrate_single() {
    if (single_.empty()) return;
    batch_.reserve(single_.size());
    batch_.size = single_.size();
    for (std::size_t i = 0; i < single_.size(); ++i) {
      const auto& [pixel, segment] = single_[i];
      const int column = static_cast<int>(pixel) % rect_.width(), row = static_cast<int>(pixel) / rect_.width();
      const double x = rect_.x0 + column + 0.5, y = rect_.y0 + row + 0.5;
      batch_.length[i] =
          static_cast<float>(segment.back - segment.front) * static_cast<float>(context_.space->length_per_depth(x, y));
      batch_.scalar_front[i] = first_scalar(segment);
      batch_.scalar_back[i] = segment.scalar_back;
    }
    integrals::integrate_lanes(*context_.table, batch_);
    for (std::size_t i = 0; i < single_.size(); ++i) {
      const auto& [pixel, segment] = single_[i];
      if (projection::is_crossing(segment.scalar_front)) put_surface_before(segment, i);
      const double front = first_visible_depth(*context_.lattice, segment, *context_.integrator);
      push(pixel, {front, static_cast<float>(context_.lattice->depth(segment.back) - front), batch_.red[i],
                   batch_.green[i], batch_.blue[i], batch_.alpha[i]});
    }
  }

  /// Returns the field's value at the front of a segment, even if the segment begins at a surface.
  [[nodiscard]] float first_scalar(const projection::LatticeSegment& segment) const {
    if (!projection::is_crossing(segment.scalar_front)) return segment.scalar_front;
    const std::uint32_t number = projection::crossing_of(segment.scalar_front).number;
    if (context_.surfaces == nullptr || number >= context_.surfaces->on_lattice_by_number().size())
      throw scene::Error(scene::ErrorCode::system_failure,
                         "exchange: received a surface that does not exist; all ranks must run the same program");
    return context_.surfaces->on_lattice_by_number()[number];
  }

  void put_surface_before(const projection::LatticeSegment& segment, std::size_t i) {
    const projection::Crossing crossing = projection::crossing_of(segment.scalar_front);
    const scene::SurfaceSet::Light light = context_.surfaces->light(crossing.number, crossing.cosine);
    const double through = 1 - light.opacity;
    const auto before = [&](double of_surface, float& behind) {
      behind = static_cast<float>(of_surface + through * behind);
    };
    before(light.red, batch_.red[i]), before(light.green, batch_.green[i]), before(light.blue, batch_.blue[i]);
    before(light.opacity, batch_.alpha[i]);
  }

  MergeContext context_;
  std::uint64_t budget_;
  scene::PixelRect rect_;
  double weight_, termination_error_;
  std::vector<Pixel> pixels_;  ///< empty until an advance() that is not the last one has runs to composite
  /// For each pixel, the run that arrived last; each run links to the previous one.
  std::vector<std::uint32_t> first_of_;
  std::vector<Run> runs_;
  std::vector<Run> here_;  ///< runs of one pixel
  std::vector<Stream> streams_;
  std::uint64_t in_streams_ = 0;  ///< number of runs that are still in `streams_`
  scene::Image image_;
  struct Single {
    std::uint32_t pixel;
    projection::LatticeSegment segment;
  };
  std::vector<Single> single_;
  integrals::FloatBatch batch_;
};

}  // namespace

std::unique_ptr<TileMerger> make_run_merger(const MergeContext& context, const scene::PixelRect& rect) {
  return std::make_unique<RunMerger>(context, rect);
}

}  // namespace tessera::compositor
