#include <fmt/format.h>

#include <algorithm>
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

/// Runs: few a pixel, composited front to back.
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
    if ((runs_.size() + part.fragments) * sizeof(Run) > budget_)
      throw scene::Error(scene::ErrorCode::system_failure,
                         fmt::format("the tile at pixel {},{} holds {} runs at once, beyond the memory budget; raise "
                                     "`memory` or make `tile_size` smaller",
                                     rect_.x0, rect_.y0, runs_.size() + part.fragments));
    exchange::RecordReader reader(part.records.bytes());
    const auto check = [&](std::uint32_t pixel) {
      if (pixel < first_of_.size()) return;
      throw scene::Error(
          scene::ErrorCode::system_failure,
          fmt::format("exchange: the runs of tile {} are malformed; all ranks must run the same program", part.tile));
    };
    if (part.kind == exchange::RecordKind::runs) {
      while (!reader.empty()) {
        const auto run = reader.take<exchange::RunRecord>();
        check(run.pixel);
        push(run.pixel, {run.front, run.thickness, run.red, run.green, run.blue, run.opacity});
      }
      return;
    }
    if (context_.lattice == nullptr || context_.table == nullptr)
      throw scene::Error(scene::ErrorCode::system_failure,
                         "exchange: runs on a lattice without one; all ranks must run the same program");
    const scene::Lattice& lattice = *context_.lattice;
    single_.clear();
    while (!reader.empty()) {
      const auto header = reader.take<exchange::RunsHeader>();
      check(header.pixel);
      for (int i = 0; i < header.runs; ++i) {
        const auto run = reader.take<exchange::LatticeRun>();
        const double front = lattice.depth(run.front);
        push(header.pixel,
             {front, static_cast<float>(lattice.depth(run.back) - front), run.red, run.green, run.blue, run.opacity});
      }
      for (int i = 0; i < header.segments; ++i)
        single_.push_back({header.pixel, reader.take<projection::LatticeSegment>()});
    }
    integrate_single();
  }

  void advance(double final_depth) override {
    const bool all = final_depth == std::numeric_limits<double>::infinity();
    if (runs_.empty() && !all) return;
    if (pixels_.empty() && !all) pixels_.resize(first_of_.size());
    if (all) image_ = scene::Image({rect_.width(), rect_.height()});
    std::vector<Run> runs = std::exchange(runs_, {});
    for (std::size_t p = 0; p < first_of_.size(); ++p) {
      const std::uint32_t first = std::exchange(first_of_[p], none);
      if (first == none && (!all || pixels_.empty())) continue;
      MergedPixel pixel = pixels_.empty() ? MergedPixel{} : pixels_[p];
      const auto composited = composite(runs, first, final_depth, pixel);
      for (auto left = composited; left != order_.end(); ++left) push(static_cast<std::uint32_t>(p), **left);
      if (all)
        pixel.write(image_, p);
      else
        pixels_[p] = pixel;
    }
  }

  MergedTile finish() override { return {std::move(image_), {}, {}}; }

 private:
  static constexpr std::uint32_t none = 0xffffffff;

  /// RunRecord, and the number of the one of its pixel that came before it.
  struct Run {
    double front;
    float thickness, red, green, blue, opacity;
    std::uint32_t next = none;
  };

  void push(std::uint32_t pixel, Run run) {
    run.next = std::exchange(first_of_[pixel], static_cast<std::uint32_t>(runs_.size()));
    runs_.push_back(run);
  }

  /// A pixel's runs before `final_depth`, front to back. Leaves all of them ordered; returns the first that is not.
  std::vector<const Run*>::const_iterator composite(const std::vector<Run>& runs, std::uint32_t first,
                                                    double final_depth, MergedPixel& pixel) {
    order_.clear();
    for (std::uint32_t i = first; i != none; i = runs[i].next) order_.push_back(&runs[i]);
    // By all a run holds: equal runs are interchangeable, so the order of arrival shows nowhere.
    const auto before = [](const Run* a, const Run* b) {
      const auto key = [](const Run& run) {
        return std::tie(run.front, run.thickness, run.opacity, run.red, run.green, run.blue);
      };
      return key(*a) < key(*b);
    };
    if (order_.size() > 1) std::sort(order_.begin(), order_.end(), before);
    auto at = order_.cbegin();
    for (; at != order_.cend() && (*at)->front < final_depth; ++at) {
      const Run& run = **at;
      if (!pixel.open) continue;
      if (run.opacity > 0) pixel.first_depth = std::min(pixel.first_depth, run.front);
      pixel.add(run.red, run.green, run.blue, run.opacity);
      pixel.open = (1 - pixel.opacity) * weight_ >= termination_error_;
    }
    return at;
  }

  /// Runs of one segment, with the bits that their projector would have found.
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

  /// The field's at the front, be there a surface or not.
  [[nodiscard]] float first_scalar(const projection::LatticeSegment& segment) const {
    if (!projection::is_crossing(segment.scalar_front)) return segment.scalar_front;
    const std::uint32_t number = projection::crossing_of(segment.scalar_front).number;
    if (context_.surfaces == nullptr || number >= context_.surfaces->on_lattice_by_number().size())
      throw scene::Error(scene::ErrorCode::system_failure,
                         "exchange: a surface that is none; all ranks must run the same program");
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
  std::vector<MergedPixel> pixels_;      ///< once something was composited before the last
  std::vector<std::uint32_t> first_of_;  ///< by pixel: its last run that came, which has the others' numbers
  std::vector<Run> runs_;
  std::vector<const Run*> order_;  ///< one pixel's
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
