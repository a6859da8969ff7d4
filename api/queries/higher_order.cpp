// SPDX-License-Identifier: BSD-3-Clause
// How far pixels are off because of the tets of higher-order cells, and how finely that makes them read.
#include "tessera/higher_order.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include "api/communicator.hpp"
#include "api/dataset.hpp"
#include "exchange/collectives.hpp"
#include "tessera/session.hpp"

namespace tessera {
inline namespace v0_1 {
namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();

/// A view with no more pixels than are compared, of the same shape.
View small(View view) {
  constexpr double most_pixels = 1 << 16;
  const double shrink = std::sqrt(most_pixels / (static_cast<double>(view.size.width) * view.size.height));
  const auto side = [&](int n) { return std::max(1, static_cast<int>(std::lround(n * shrink))); };
  if (shrink < 1) view.size = {side(view.size.width), side(view.size.height)};
  return view;
}

/// p in [1/2, 1] for which errors in proportion to t^p make pictures of tolerances t0 > t1 > t2 differ by d1 and d2.
double power_of(double t0, double t1, double t2, double d1, double d2) {
  double low = 0.5, high = 1;  // what falls faster is taken to fall so
  for (int halvings = 0; halvings < 30; ++halvings) {
    const double p = 0.5 * (low + high);
    const bool falls_faster = d1 * (std::pow(t1, p) - std::pow(t2, p)) > d2 * (std::pow(t0, p) - std::pow(t1, p));
    (falls_faster ? low : high) = p;
  }
  return low;
}

/// Tets of one tolerance.
struct Level {
  double tolerance;
  std::uint64_t tets;
  Image picture;  ///< on the rank that assembles it
};

/// How two pictures differ.
struct Difference {
  double largest = 0, root_mean_square = 0;
};

/// Reads, draws and compares: what read_for_accuracy() does on the way.
class HigherOrderLevels {
 public:
  HigherOrderLevels(const std::function<Dataset(const ReadOptions&)>& open,
                    const std::function<TransferFunction(const Dataset&)>& function,
                    const std::function<View(const Dataset&)>& view, const Settings& settings,
                    const Communicator& communicator)
      : open_(open), function_(function), view_(view), communicator_(communicator) {
    settings_.emission = settings.emission;
    settings_.threads = settings.threads;
    settings_.memory_bytes = settings.memory_bytes;
    settings_.ranks = settings.ranks;
    settings_.ranks.exchange = Exchange::segments;  // the same tolerance for any number of ranks
    settings_.integrator.accuracy = 4e-6;           // of the least that float lanes can do
  }

  /// Draws what was read. Of fewer than twice the tets of the last picture it takes that one's place: what they differ
  /// by is of a few cells alone.
  void draw(const Dataset& data) {
    const HigherOrderCells& cells = data.higher_order_cells();
    if (!levels_.empty() && cells.tets < 2 * levels_.back().tets) levels_.pop_back();
    levels_.push_back({cells.tolerance, cells.tets, picture(data)});
    if (levels_.size() >= 2) fit();
  }

  /// Finds the error of the one level drawn by two with larger tolerances, of a tenth of the tets.
  void compare_with_coarser(ReadOptions options) {
    for (const double times : {4, 16}) {
      options.higher_order_tolerance = times * levels_.back().tolerance;
      const Dataset coarser = open_(options);
      const HigherOrderCells& cells = coarser.higher_order_cells();
      if (2 * cells.tets > levels_.front().tets) continue;
      levels_.insert(levels_.begin(), {cells.tolerance, cells.tets, picture(coarser)});
      fit();
    }
  }

  [[nodiscard]] std::size_t pictures() const { return levels_.size(); }
  /// Of the last picture; infinite as long as none differ.
  [[nodiscard]] double error() const { return error_; }
  [[nodiscard]] double tolerance_for(double error) const {
    const double power = levels_.size() < 3 ? 0.75 : power_;  // half way, as long as it is not known
    return levels_.back().tolerance * std::pow(error / error_, 1 / power);
  }

 private:
  [[nodiscard]] Image picture(const Dataset& data) {
    if (!scene_) scene_.emplace(view_ ? small(view_(data)) : data.default_view({128, 128}), function_(data));
    Session session(data, settings_, communicator_);
    return session.render(scene_->first, scene_->second).image;
  }

  /// The last level before one whose tolerance is four times its, or the first: less apart, the worst tets of the one
  /// may be those of the other.
  [[nodiscard]] const Level& coarser_than(const Level& level) const {
    const auto is_apart = [&](const Level& of) { return of.tolerance >= 3.99 * level.tolerance; };
    const auto found = std::find_if(levels_.rbegin(), levels_.rend(), is_apart);
    return found == levels_.rend() ? levels_.front() : *found;
  }

  /// The error as a power of the tolerance, by three pictures. Of two the power is the least there is, which leaves
  /// room enough.
  void fit() {
    const Level &last = levels_.back(), &middle = coarser_than(last), &first = coarser_than(middle);
    const Difference difference_of_last = difference(middle.picture, last.picture);
    power_ = 0.5;
    double by_chance = 1;
    if (first.tolerance > middle.tolerance) {
      // The largest difference depends on a few pixels, along the surface; the mean is of all.
      power_ =
          power_of(first.tolerance, middle.tolerance, last.tolerance,
                   difference(first.picture, middle.picture).root_mean_square, difference_of_last.root_mean_square);
      by_chance = 1.75;
    }
    const double apart = middle.tolerance / last.tolerance;
    error_ = apart > 1 ? by_chance * difference_of_last.largest / (std::pow(apart, power_) - 1) : infinite;
  }

  /// The same on all ranks.
  [[nodiscard]] Difference difference(const Image& a, const Image& b) const {
    const int assembler =
        assign_roles(communicator_.size(), settings_.ranks.projectors, settings_.ranks.compositors).assembler();
    Difference found;
    if (communicator_.rank() == assembler) {
      double squares = 0;
      for (std::size_t i = 0; i < a.rgba.size(); ++i) {
        const double by = std::abs(static_cast<double>(a.rgba[i]) - b.rgba[i]);
        found.largest = std::max(found.largest, by);
        squares += by * by;
      }
      found.root_mean_square = std::sqrt(squares / static_cast<double>(std::max<std::size_t>(1, a.rgba.size())));
    }
    if (communicator_.size() == 1) return found;
    const auto transport = StateAccess::of(communicator_).connect();
    return exchange::broadcast_value(*transport, assembler, exchange::MessageKind::higher_order, found);
  }

  const std::function<Dataset(const ReadOptions&)>& open_;
  const std::function<TransferFunction(const Dataset&)>& function_;
  const std::function<View(const Dataset&)>& view_;
  Settings settings_;
  const Communicator& communicator_;
  std::optional<std::pair<View, TransferFunction>> scene_;  ///< of the first level, and all others
  std::vector<Level> levels_;
  double power_ = 0.5, error_ = infinite;  ///< the error is in proportion to tolerance^power
};

}  // namespace

HigherOrderRead read_for_accuracy(const ReadOptions& options, std::optional<double> accuracy,
                                  const std::function<Dataset(const ReadOptions&)>& open,
                                  const std::function<TransferFunction(const Dataset&)>& function,
                                  const std::function<View(const Dataset&)>& view, const Settings& settings,
                                  const Communicator& communicator) {
  HigherOrderLevels levels(open, function, view, settings, communicator);
  constexpr int most_levels = 12;  // cells may be the same tets at several
  ReadOptions read = options;
  if (accuracy) read.higher_order_tolerance = first_higher_order_tolerance(*accuracy);
  for (int level = 1;; ++level) {
    std::optional<Dataset> data(open(read));
    const HigherOrderCells cells = data->higher_order_cells();
    const auto taken = [&](double error) {
      return HigherOrderRead{std::move(*data), read, cells.by_corners > 0 ? infinite : error};
    };
    if (cells.divided == 0) return taken(0);
    levels.draw(*data);
    const bool is_limited = cells.tolerance > read.higher_order_tolerance * (1 + 1e-9);
    if (!accuracy || is_limited || level == most_levels || levels.error() <= *accuracy) {
      if (levels.pictures() == 1) levels.compare_with_coarser(read);
      return taken(levels.error());
    }
    data.reset();  // its memory before the next one's
    // A little less than what is asked for is asked for, since one more level costs as much again.
    const double wanted = levels.pictures() < 2 ? 0 : levels.tolerance_for(0.8 * *accuracy);
    read.higher_order_tolerance =
        std::clamp(wanted, cells.tolerance / (levels.pictures() < 2 ? 4 : 8), cells.tolerance / 2);
  }
}

}  // namespace v0_1
}  // namespace tessera
