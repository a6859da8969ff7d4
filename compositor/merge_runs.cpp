#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>
#include <utility>
#include <vector>

#include "compositor/integrate_lanes.hpp"
#include "compositor/merge_kinds.hpp"
#include "compositor/merged_pixel.hpp"
#include "compositor/window_kernel.hpp"

namespace tessera::compositor {
namespace {

/// Runs: few a pixel, composited front to back.
class RunMerger final : public TileMerger {
 public:
  RunMerger(const MergeContext& context, const projection::PixelRect& rect)
      : context_(context),
        budget_(context.budget_bytes),
        rect_(rect),
        weight_(opacity_weight(context.max_color, context.longest_ray, context.emission)),
        termination_error_(context.integrator->termination_error()),
        pixels_(static_cast<std::size_t>(rect.area())) {}

  void add(const TilePart& part) override {
    if ((runs_.size() + part.fragments) * sizeof(RunRecord) > budget_)
      throw scene::Error(scene::ExitCode::system_failure,
                         fmt::format("the tile at pixel {},{} holds {} runs at once, beyond the memory budget; raise "
                                     "--memory or make --tile-size smaller",
                                     rect_.x0, rect_.y0, runs_.size() + part.fragments));
    RecordReader reader(part.records);
    const auto check = [&](std::uint32_t pixel) {
      if (pixel < pixels_.size()) return;
      throw scene::Error(
          scene::ExitCode::system_failure,
          fmt::format("exchange: the runs of tile {} are malformed; all ranks must run the same program", part.tile));
    };
    if (part.kind == RecordKind::runs) {
      while (!reader.empty()) {
        const auto run = reader.take<RunRecord>();
        check(run.pixel);
        runs_.push_back(run);
      }
      return;
    }
    if (context_.lattice == nullptr || context_.table == nullptr)
      throw scene::Error(scene::ExitCode::system_failure,
                         "exchange: runs on a lattice without one; all ranks must run the same program");
    const projection::Lattice& lattice = *context_.lattice;
    single_.clear();
    while (!reader.empty()) {
      const auto header = reader.take<RunsHeader>();
      check(header.pixel);
      for (int i = 0; i < header.runs; ++i) {
        const auto run = reader.take<LatticeRun>();
        const double front = lattice.depth(run.front);
        runs_.push_back({front, static_cast<float>(lattice.depth(run.back) - front), run.red, run.green, run.blue,
                         run.optical_depth, header.pixel});
      }
      for (int i = 0; i < header.segments; ++i)
        single_.push_back({header.pixel, reader.take<projection::LatticeSegment>()});
    }
    integrate_single();
  }

  void advance(double final_depth) override {
    if (runs_.empty()) return;
    // By all a run holds: equal runs are interchangeable, so the order of arrival shows nowhere.
    const auto before = [&](std::uint32_t a, std::uint32_t b) {
      const auto key = [](const RunRecord& run) {
        return std::tie(run.front, run.thickness, run.optical_depth, run.red, run.green, run.blue);
      };
      return key(runs_[a]) < key(runs_[b]);
    };
    chain_by_pixel();
    for (std::size_t pixel = 0; pixel < pixels_.size(); ++pixel) {
      const std::uint32_t first = first_of_[pixel];
      if (first == none) continue;
      order_.clear();
      for (std::uint32_t i = first; i != none; i = next_[i]) order_.push_back(i);
      if (order_.size() > 1) std::sort(order_.begin(), order_.end(), before);
      for (auto i = order_.begin(); i != order_.end() && runs_[*i].front < final_depth; ++i)
        composite(runs_[*i], pixels_[pixel]);
    }
    if (final_depth == std::numeric_limits<double>::infinity())
      runs_.clear();
    else
      std::erase_if(runs_, [&](const RunRecord& run) { return run.front < final_depth; });
  }

  MergedTile finish() override { return {image_of(pixels_, {rect_.width(), rect_.height()}), {}, {}}; }

 private:
  static constexpr std::uint32_t none = 0xffffffff;

  /// Numbers of runs, pixel by pixel: those of pixel p are i = first_of_[p], next_[i] and so on, up to `none`.
  void chain_by_pixel() {
    first_of_.assign(pixels_.size(), none);
    next_.resize(runs_.size());
    for (std::uint32_t i = 0; i < runs_.size(); ++i) next_[i] = std::exchange(first_of_[runs_[i].pixel], i);
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
      batch_.scalar_front[i] = segment.scalar_front;
      batch_.scalar_back[i] = segment.scalar_back;
    }
    integrate_lanes(*context_.table, batch_);
    for (std::size_t i = 0; i < single_.size(); ++i) {
      const auto& [pixel, segment] = single_[i];
      const double front = first_visible_depth(*context_.lattice, segment, *context_.integrator);
      runs_.push_back({front, static_cast<float>(context_.lattice->depth(segment.back) - front), batch_.red[i],
                       batch_.green[i], batch_.blue[i], batch_.optical_depth[i], pixel});
    }
  }

  void composite(const RunRecord& run, MergedPixel& pixel) const {
    if (!pixel.open) return;
    if (pixel.optical_depth == 0 && run.optical_depth > 0) pixel.first_depth = run.front;
    pixel.red += pixel.transmittance * double{run.red};
    pixel.green += pixel.transmittance * double{run.green};
    pixel.blue += pixel.transmittance * double{run.blue};
    pixel.optical_depth += double{run.optical_depth};
    pixel.transmittance *= std::exp(-double{run.optical_depth});
    pixel.open = pixel.transmittance * weight_ >= termination_error_;
  }

  MergeContext context_;
  std::uint64_t budget_;
  projection::PixelRect rect_;
  double weight_, termination_error_;
  std::vector<MergedPixel> pixels_;
  std::vector<RunRecord> runs_;
  std::vector<std::uint32_t> order_, first_of_, next_;
  struct Single {
    std::uint32_t pixel;
    projection::LatticeSegment segment;
  };
  std::vector<Single> single_;
  FloatBatch batch_;
};

}  // namespace

std::unique_ptr<TileMerger> make_run_merger(const MergeContext& context, const projection::PixelRect& rect) {
  return std::make_unique<RunMerger>(context, rect);
}

}  // namespace tessera::compositor
