// SPDX-License-Identifier: BSD-3-Clause
#include "frame/grid/sort_first.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numeric>
#include <optional>
#include <random>
#include <utility>
#include <vector>

#include "exchange/collectives.hpp"
#include "frame/grid/split_by_times.hpp"
#include "frame/ranks/reduce.hpp"
#include "scene/error.hpp"
#include "scene/threads.hpp"
#include "volume/split/learned_work.hpp"

namespace tessera::frame {
namespace {

using exchange::append_list;
using exchange::Bytes;
using exchange::message_of;
using exchange::MessageKind;
using exchange::MessageReader;
using scene::PixelRect;
using volume::CostMap;
using volume::ImageSplit;

PixelRect scaled(const PixelRect& r, double resolution, scene::ImageSize map, scene::ImageSize image) {
  const auto edge = [&](int v, int length, int map_length) {
    return v == length ? map_length : std::min(map_length, static_cast<int>(std::floor(v * resolution)));
  };
  return {edge(r.x0, image.width, map.width), edge(r.y0, image.height, map.height), edge(r.x1, image.width, map.width),
          edge(r.y1, image.height, map.height)};
}

/// Resolution of the cost map. If costs are learned from pilot rays, one map pixel per packet of rays is enough; more
/// do not improve the split.
double resolution_of(const RankSettings& settings) {
  return settings.balance == Balance::learned ? std::min(settings.balance_resolution, 1.0 / volume::region_grain)
                                              : settings.balance_resolution;
}

/// Identifies this process among those of all machines.
std::uint64_t process_token() {
  static const std::uint64_t token = [] {
    std::random_device device;
    return std::uint64_t{device()} << 32 | device();
  }();
  return token;
}

volume::CostMethod method_of(Balance balance) {
  switch (balance) {
    case Balance::accurate:
      return volume::CostMethod::accurate;
    case Balance::backface:
      return volume::CostMethod::backface;
    case Balance::splatting:
      return volume::CostMethod::splatting;
    default:
      return volume::CostMethod::visited;
  }
}

}  // namespace

/// One rank's state.
class SortFirst::State {
 public:
  State(exchange::Transport& transport, const Settings& settings, const FrameSettings& frame)
      : transport_(transport),
        settings_(settings.ranks),
        frame_(frame),
        threads_(settings.threads),
        trace_(settings.trace),
        weights_(weights_are_given() ? settings_.balance_weights
                                     : std::vector<double>(static_cast<std::size_t>(transport.size()), 1.0)) {
    if (weights_.size() != static_cast<std::size_t>(transport.size()))
      throw scene::bad_input(fmt::format("balance: there are {} weights for {} processes; give one for each",
                                         weights_.size(), transport.size()));
    if (settings_.balance_measured && weights_are_given())
      throw scene::bad_input("`balance_weights`: weights cannot be both given and measured; leave one of the two out");
    if (!std::all_of(weights_.begin(), weights_.end(), [](double w) { return w > 0 && std::isfinite(w); }))
      throw scene::bad_input("balance: weights must be positive numbers");
  }

  VolumePart make(volume::Renderer& renderer, const scene::TransferFunction& function, const VolumeJob& job,
                  std::size_t number, scene::FrameWatch& watch) {
    const double cpu_at_first = process_cpu_seconds();
    const ImageSplit split = [&] {
      const scene::TraceScope timing(trace_, "partition", static_cast<std::int32_t>(number));
      if (std::optional<ImageSplit> known = known_split(renderer, function, job)) return std::move(*known);
      sample_work(renderer, function, job, watch);
      return split_of(renderer, function, job);
    }();
    const std::vector<PixelRect> mine = split.parts(transport_.rank());
    const double cpu_before = process_cpu_seconds();
    volume::Frame made;
    bool stopped = false;
    try {
      made = renderer.render(job.camera, job.size, function,
                             {.regions = mine, .error_bounds = frame_.keep_uncertainty, .tile_times = uses_times()},
                             &watch);
    } catch (const scene::FrameStopped&) {
      stopped = true;
      made.image = scene::Image(job.size);
      if (frame_.keep_uncertainty) made.error_bounds.resize(made.image.depth.size());
    }
    const double cpu = process_cpu_seconds() - cpu_before;
    if (settings_.balance == Balance::previous) share_times(cpu);
    if (settings_.balance_measured && !uses_times()) learn_speed(cpu, stopped);
    last_split_ = split;
    last_size_ = job.size;
    VolumePart part;
    part.header = {number, split.region(transport_.rank()), made.statistics,
                   cpu,    cpu_before - cpu_at_first,       stopped ? 1u : 0u};
    part.rectangles = mine;
    part.finished.image = std::move(made.image);
    part.finished.error_bounds = std::move(made.error_bounds);
    part.finished.statistics = std::move(made.statistics);
    part.finished.split = split;
    part.finished.cost = std::move(cost_);
    if (uses_times()) timed_ = job, times_here_ = {!stopped, process_token(), cpu, std::move(made.tile_times)};
    return part;
  }

 private:
  [[nodiscard]] bool weights_are_given() const { return !settings_.balance_weights.empty(); }

  /// Whether tiles are timed and splits are computed from the times. This is not done with weights, which distribute
  /// work rather than time, nor with a cost map to show, which must be the same in each run.
  [[nodiscard]] bool uses_times() const {
    return settings_.balance == Balance::learned && transport_.size() > 1 && !weights_are_given() && !frame_.keep_cost;
  }

  /// Returns the split that rank 0 computes from earlier frames. If there is none, rank 0 may still set the ranks'
  /// weights for another split. Collective.
  std::optional<ImageSplit> known_split(const volume::Renderer& renderer, const scene::TransferFunction& function,
                                        const VolumeJob& job) {
    if (!uses_times()) return std::nullopt;
    const scene::Box box = scene::bounds(renderer.geometry());
    const bool alike = std::ranges::equal(function.knots(), timed_knots_);
    timed_knots_.assign(function.knots().begin(), function.knots().end());
    if (timed_) learn_times(*std::exchange(timed_, std::nullopt), box);
    if (!alike) by_times_ = {};
    if (transport_.rank() != 0) return receive_split(exchange::broadcast(transport_, 0, {}));
    const std::optional<ImageSplit> split = by_times_.find(job, box);
    Bytes bytes = exchange::message_of(MessageKind::image_split, std::uint8_t{split.has_value()});
    if (split) {
      append_list(bytes, split->rows);
      for (const std::vector<int>& columns : split->columns) append_list(bytes, columns);
      for (const std::vector<int>& steps : split->steps) append_list(bytes, steps);
    } else {
      append_list(bytes, by_times_.weights());
    }
    return receive_split(exchange::broadcast(transport_, 0, std::move(bytes)));
  }

  std::optional<ImageSplit> receive_split(const Bytes& bytes) {
    MessageReader reader(bytes, 0, MessageKind::image_split);
    std::optional<ImageSplit> split;
    if (reader.take<std::uint8_t>() != 0) {
      split.emplace();
      split->rows = reader.take_list<int>();
      for (auto* edges : {&split->columns, &split->steps})
        for (std::size_t row = 1; row < split->rows.size(); ++row) edges->push_back(reader.take_list<int>());
      for (std::size_t row = 0; row < split->columns.size(); ++row)
        if (split->columns[row].empty() || split->columns[row].size() != split->steps[row].size())
          reader.refuse("has edges without steps");
      if (split->processes() != transport_.size()) reader.refuse("is a split for another number of ranks");
    } else if (const auto weights = reader.take_list<double>(); !weights.empty()) {
      weights_ = weights;
    }
    reader.finish();
    return split;
  }

  /// Sends the times of the frame of `job` to rank 0. Collective.
  void learn_times(const VolumeJob& job, const scene::Box& box) {
    if (transport_.rank() != 0) {
      Bytes bytes = exchange::message_of(MessageKind::tile_times, std::uint8_t{times_here_.whole});
      exchange::append(bytes, times_here_.process);
      exchange::append(bytes, times_here_.cpu_seconds);
      append_list(bytes, times_here_.tiles);
      transport_.send(0, exchange::Channel::agreement, std::move(bytes));
      return;
    }
    std::vector<CastTimes> ranks(static_cast<std::size_t>(transport_.size()));
    ranks[0] = std::move(times_here_);
    for (int others = transport_.size() - 1; others > 0; --others) {
      const exchange::Message message = transport_.receive(exchange::Channel::agreement);
      MessageReader reader(message, MessageKind::tile_times);
      CastTimes& times = ranks[static_cast<std::size_t>(message.from)];
      times.whole = reader.take<std::uint8_t>() != 0;
      times.process = reader.take<std::uint64_t>();
      times.cpu_seconds = reader.take<double>();
      if (!std::isfinite(times.cpu_seconds)) reader.refuse("has a time that is not a number");
      times.tiles = reader.take_list<volume::TileTime>();
      reader.finish();
      for (const auto& [pixels, microseconds] : times.tiles)
        if (pixels.x0 < 0 || pixels.y0 < 0 || pixels.x1 > job.size.width || pixels.y1 > job.size.height ||
            !(microseconds >= 0) || !std::isfinite(microseconds))
          reader.refuse("has times of pixels outside of the image");
    }
    by_times_.learn(job, box, ranks);
  }

  ImageSplit split_of(const volume::Renderer& renderer, const scene::TransferFunction& function, const VolumeJob& job) {
    const int processes = transport_.size();
    const Balance balance = settings_.balance;
    const auto cost_of = [&](double resolution, std::optional<PixelRect> part) {
      return renderer.cost_map(job.camera, job.size, function,
                               {.method = method_of(balance),
                                .resolution = resolution,
                                .learned = rates_ ? &*rates_ : nullptr,
                                .region = part});
    };
    const bool by_times = balance == Balance::previous && !times_.empty();
    if (frame_.keep_cost && transport_.rank() == 0)
      cost_ = by_times ? map_of_times(job.size) : cost_of(settings_.balance_resolution, {});
    if (processes == 1) return {{0, job.size.height}, {{0, job.size.width}}};
    const PixelRect area = volume::footprint(job.camera, job.size, renderer.geometry());
    if (by_times) return volume::split(map_of_times(job.size), job.size, weights_, volume::region_grain);
    if (balance == Balance::even || balance == Balance::previous) return volume::even_split(processes, job.size, area);

    const double resolution = resolution_of(settings_);
    const scene::ImageSize map = volume::map_size(job.size, resolution);
    const PixelRect map_area = scaled(area, resolution, map, job.size);
    const bool has_last = last_split_.has_value() && last_size_ == job.size;
    const PixelRect part = has_last ? scaled(last_split_->region(transport_.rank()), resolution, map, job.size)
                                    : volume::even_split(processes, map, map_area).region(transport_.rank());
    const CostMap costs = cost_of(resolution, part);
    const volume::SummedArea table(costs);
    volume::SplitSearch search(job.size, resolution, map, weights_, volume::region_grain);
    search.find_rows(gather_rows(volume::SplitSearch::row_sums(costs, table)));
    return search.find_columns(gather_columns(volume::SplitSearch::column_sums(costs, table, search.map_rows())));
  }

  /// Learns the work in the volume's cells from a pilot pass: each rank casts every 128th ray of its rectangle in the
  /// last frame, whose bricks it has in memory. Four times as many rays cost more than they gain. A cell's work changes
  /// little between views, so a frame whose view is close to the last view casts other rays, and learns from the rays
  /// of both frames. Collective.
  void sample_work(volume::Renderer& renderer, const scene::TransferFunction& function, const VolumeJob& job,
                   scene::FrameWatch& watch) {
    if ((transport_.size() == 1 && !frame_.keep_cost) || settings_.balance != Balance::learned) return;
    const bool has_last = last_split_.has_value() && last_size_ == job.size;
    const PixelRect area = volume::footprint(job.camera, job.size, renderer.geometry());
    const PixelRect part = has_last ? last_split_->region(transport_.rank())
                                    : volume::even_split(transport_.size(), job.size, area).region(transport_.rank());
    if (!tally_ || !std::ranges::equal(function.knots(), learned_knots_) || !learned_view_ ||
        !is_near(job.camera, *learned_view_, scene::bounds(renderer.geometry()), 0.1)) {
      tally_.emplace(renderer.geometry().voxels());
      learned_knots_.assign(function.knots().begin(), function.knots().end());
      learned_.assign(2 * tally_->cells().count(), 0);
      pilots_ = 0;
    }
    learned_view_ = job.camera;
    constexpr std::size_t turns = 4;
    try {
      renderer.sample_work(job.camera, job.size, function, *tally_, {part, pilots_, turns}, &watch);
    } catch (const scene::FrameStopped&) {
      // The other ranks wait for this rank's result; the frame is dropped anyway.
    }
    ++pilots_;
    volume::WorkRates::add(reduce_all(transport_, tally_->take(), Reduction::sum), learned_);
    rates_.emplace(renderer.geometry().voxels());
    rates_->learn(learned_);
  }

  std::vector<volume::RowSums> gather_rows(const volume::RowSums& own) {
    Bytes bytes = message_of(MessageKind::row_costs, own.region);
    append_list(bytes, own.rows);
    std::vector<volume::RowSums> all;
    for (const Bytes& of_rank : exchange::gather_all(transport_, std::move(bytes))) {
      MessageReader reader(of_rank, static_cast<int>(all.size()), MessageKind::row_costs);
      volume::RowSums& part = all.emplace_back();
      part.region = reader.take<PixelRect>();
      part.rows = reader.take_list<std::uint64_t>();
      reader.finish();
    }
    return all;
  }

  std::vector<volume::ColumnSums> gather_columns(const volume::ColumnSums& own) {
    Bytes bytes = message_of(MessageKind::column_costs, own.region);
    for (const auto& columns : own.columns) append_list(bytes, columns);
    std::vector<volume::ColumnSums> all;
    for (const Bytes& of_rank : exchange::gather_all(transport_, std::move(bytes))) {
      MessageReader reader(of_rank, static_cast<int>(all.size()), MessageKind::column_costs);
      volume::ColumnSums& part = all.emplace_back();
      part.region = reader.take<PixelRect>();
      part.columns.resize(own.columns.size());
      for (auto& columns : part.columns) {
        columns = reader.take_list<std::uint64_t>();
        if (columns.size() != static_cast<std::size_t>(std::max(0, part.region.x1 - part.region.x0)))
          reader.refuse("has other columns than its region");
      }
      reader.finish();
    }
    return all;
  }

  void share_times(double cpu) { times_ = exchange::gather_values(transport_, MessageKind::seconds, cpu); }

  /// Sets the weights by each rank's CPU time per thread in the last frame: a rank that took longer than the mean gets
  /// less of the next frame. Applies only half of the correction, because costs are estimates. Collective.
  void learn_speed(double cpu_seconds, bool stopped) {
    const double own = stopped ? 0 : cpu_seconds / scene::threads_for(threads_);
    const std::vector<double> seconds = exchange::gather_values(transport_, MessageKind::seconds, own);
    // The time of a rank that had almost no work does not measure its speed.
    const double most = *std::max_element(seconds.begin(), seconds.end());
    if (!std::ranges::all_of(seconds, [&](double t) { return t > 0.01 * most; })) return;
    const double mean = std::accumulate(seconds.begin(), seconds.end(), 0.0) / static_cast<double>(seconds.size());
    for (std::size_t rank = 0; rank < seconds.size(); ++rank) weights_[rank] *= std::sqrt(mean / seconds[rank]);
  }

  /// Returns the times of the last frame; each time is spread evenly over its rectangle.
  [[nodiscard]] CostMap map_of_times(scene::ImageSize size) const {
    CostMap map;
    map.resolution = settings_.balance_resolution;
    map.size = volume::map_size(size, settings_.balance_resolution);
    map.region = {0, 0, map.size.width, map.size.height};
    map.cost.assign(static_cast<std::size_t>(map.size.width) * static_cast<std::size_t>(map.size.height), 0);
    for (int rank = 0; rank < transport_.size(); ++rank) {
      const PixelRect r = scaled(last_split_->region(rank), settings_.balance_resolution, map.size, last_size_);
      const double pixels = std::max(1.0, static_cast<double>(r.x1 - r.x0) * (r.y1 - r.y0));
      const double nanoseconds = 1e9 * times_[static_cast<std::size_t>(rank)] / pixels;
      for (int y = r.y0; y < std::min(r.y1, map.size.height); ++y)
        for (int x = r.x0; x < std::min(r.x1, map.size.width); ++x)
          map.cost[static_cast<std::size_t>(y) * static_cast<std::size_t>(map.size.width) +
                   static_cast<std::size_t>(x)] = static_cast<std::uint32_t>(std::min(nanoseconds, 4e9));
    }
    return map;
  }

  exchange::Transport& transport_;
  const RankSettings settings_;
  const FrameSettings frame_;
  const int threads_;
  scene::Trace* const trace_;
  std::vector<double> weights_, times_;
  std::optional<volume::WorkTally> tally_;
  std::vector<std::uint64_t> learned_;         ///< tallies of all ranks since the last large change of view
  std::size_t pilots_ = 0;                     ///< number of pilot passes since then
  std::vector<tessera::Knot> learned_knots_;   ///< knots of the last frame
  std::optional<scene::Camera> learned_view_;  ///< view of the last frame
  std::optional<volume::WorkRates> rates_;
  std::optional<ImageSplit> last_split_;
  scene::ImageSize last_size_{0, 0};
  SplitByTimes by_times_;                   ///< only on rank 0
  std::optional<VolumeJob> timed_;          ///< the last frame, until its times reach rank 0
  CastTimes times_here_;                    ///< the times of that frame on this rank
  std::vector<tessera::Knot> timed_knots_;  ///< knots of that frame
  CostMap cost_;
};

SortFirst::SortFirst(exchange::Transport& transport, const Settings& settings, const FrameSettings& frame)
    : VolumeFrames(transport, settings.trace), state_(std::make_unique<State>(transport, settings, frame)) {}
SortFirst::~SortFirst() = default;

VolumePart SortFirst::make(volume::Renderer& renderer, const scene::TransferFunction& function, const VolumeJob& job,
                           std::size_t number, scene::FrameWatch& watch) {
  return state_->make(renderer, function, job, number, watch);
}

}  // namespace tessera::frame
