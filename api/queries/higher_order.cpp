// SPDX-License-Identifier: BSD-3-Clause
// Estimates the error of pixels that is due to the tets of higher-order cells, and how finely to divide these.
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

/// Returns the view with the number of pixels that are compared: more than the image's, because the largest errors are
/// at few rays along the surface.
View compared(View view) {
  constexpr double pixels = 1 << 16;
  const double factor = std::min(4.0, std::sqrt(pixels / (static_cast<double>(view.size.width) * view.size.height)));
  const auto side = [&](int n) { return std::max(1, static_cast<int>(std::lround(n * factor))); };
  view.size = {side(view.size.width), side(view.size.height)};
  return view;
}

/// Returns the exponent p in [1/2, 1] for which errors in proportion to t^p explain the differences between images of
/// tolerances t0 > t1 > t2: d1 between the first two and d2 between the last two.
double power_of(double t0, double t1, double t2, double d1, double d2) {
  double low = 0.5, high = 1;  // faster convergence is treated as p = 1
  for (int halvings = 0; halvings < 30; ++halvings) {
    const double p = 0.5 * (low + high);
    const bool falls_faster = d1 * (std::pow(t1, p) - std::pow(t2, p)) > d2 * (std::pow(t0, p) - std::pow(t1, p));
    (falls_faster ? low : high) = p;
  }
  return low;
}

/// The mesh and image of one tolerance.
struct Level {
  double tolerance;
  std::uint64_t tets;
  Image picture;  ///< on the rank that assembles the image; empty on other ranks
};

/// The difference of two images.
struct Difference {
  double largest = 0, root_mean_square = 0;
};

/// Reads, renders and compares data of several tolerances: the steps of read_for_accuracy().
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
    settings_.ranks.exchange = Exchange::segments;  // so that the result is the same tolerance for any number of ranks
    settings_.integrator.accuracy = 4e-6;           // about the best accuracy of single precision
  }

  /// Renders the data as a new level. If they have fewer than twice as many tets as the last level, the new level
  /// replaces that level, since only a few cells differ.
  void draw(const Dataset& data) {
    const HigherOrderCells& cells = data.higher_order_cells();
    if (!levels_.empty() && cells.tets < 2 * levels_.back().tets) levels_.pop_back();
    levels_.push_back({cells.tolerance, cells.tets, picture(data)});
    error_ = infinite;
    if (levels_.size() >= 2) fit();
  }

  /// For few tets: estimates the error of the last level by comparison with the first of several finer levels that has
  /// at least twice as many tets. A tolerance of a quarter reduces the error to about a half or less, so the error of
  /// the last level is at most about twice the difference.
  void compare_with_finer(ReadOptions options) {
    constexpr std::uint64_t few_tets = 1 << 16;
    const Level& last = levels_.back();
    for (double times = 4; times <= 64 && last.tets <= few_tets; times *= 4) {
      options.higher_order_tolerance = last.tolerance / times;
      const Dataset finer = open_(options);
      const HigherOrderCells& cells = finer.higher_order_cells();
      if (cells.tolerance > options.higher_order_tolerance * (1 + 1e-9)) return;  // limited by `higher_order_tets`
      if (cells.tets < 2 * last.tets) continue;
      error_ = 2 * difference(last.picture, picture(finer)).largest;
      return;
    }
  }

  /// Estimates the error of the only level by comparison with two levels of larger tolerances, each with at most half
  /// of the tets.
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

  /// Error of the last level; infinite if there are no two images to compare.
  [[nodiscard]] double error() const { return error_; }
  [[nodiscard]] double tolerance_for(double error) const {
    const double power = levels_.size() < 3 ? 0.75 : power_;  // the middle of the possible range while the power is
                                                              // unknown
    return levels_.back().tolerance * std::pow(error / error_, 1 / power);
  }

 private:
  [[nodiscard]] Image picture(const Dataset& data) {
    if (!scene_) scene_.emplace(view_ ? compared(view_(data)) : data.default_view({128, 128}), function_(data));
    Session session(data, settings_, communicator_);
    return session.render(scene_->first, scene_->second).image;
  }

  /// Returns the last level whose tolerance is at least four times larger or, if there is none, the first level. The
  /// worst tets of two levels with closer tolerances may be the same.
  [[nodiscard]] const Level& coarser_than(const Level& level) const {
    const auto is_apart = [&](const Level& of) { return of.tolerance >= 3.99 * level.tolerance; };
    const auto found = std::find_if(levels_.rbegin(), levels_.rend(), is_apart);
    return found == levels_.rend() ? levels_.front() : *found;
  }

  /// Fits a power of the tolerance to the differences of three images. With two images, the power is set to its lower
  /// bound, which is conservative.
  void fit() {
    const Level &last = levels_.back(), &middle = coarser_than(last), &first = coarser_than(middle);
    const Difference difference_of_last = difference(middle.picture, last.picture);
    power_ = 0.5;
    double by_chance = 1;
    if (first.tolerance > middle.tolerance) {
      // The largest difference depends on a few pixels along the surface; the mean depends on all pixels.
      power_ =
          power_of(first.tolerance, middle.tolerance, last.tolerance,
                   difference(first.picture, middle.picture).root_mean_square, difference_of_last.root_mean_square);
      by_chance = 1.75;
    }
    const double apart = middle.tolerance / last.tolerance;
    error_ = apart > 1 ? by_chance * difference_of_last.largest / (std::pow(apart, power_) - 1) : infinite;
  }

  /// Returns the difference of two images, with the same result on all ranks.
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
  std::optional<std::pair<View, TransferFunction>> scene_;  ///< view and transfer function of the first level, used for
                                                            ///< all levels
  std::vector<Level> levels_;
  double power_ = 0.5, error_ = infinite;  ///< the error is proportional to tolerance^power
};

}  // namespace

HigherOrderRead read_for_accuracy(const ReadOptions& options, std::optional<double> accuracy,
                                  const std::function<Dataset(const ReadOptions&)>& open,
                                  const std::function<TransferFunction(const Dataset&)>& function,
                                  const std::function<View(const Dataset&)>& view, const Settings& settings,
                                  const Communicator& communicator) {
  HigherOrderLevels levels(open, function, view, settings, communicator);
  constexpr int most_levels = 12;  // several tolerances may give the same tets
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
    levels.compare_with_finer(read);
    const bool is_limited = cells.tolerance > read.higher_order_tolerance * (1 + 1e-9);
    if (!accuracy || is_limited || level == most_levels || levels.error() <= *accuracy) {
      if (!std::isfinite(levels.error())) levels.compare_with_coarser(read);
      return taken(levels.error());
    }
    data.reset();  // free its memory before the next data set is read
    // The target is slightly below the requested accuracy, because missing it would cost one more level.
    const bool is_known = std::isfinite(levels.error());
    const double wanted = is_known ? levels.tolerance_for(0.8 * *accuracy) : 0;
    read.higher_order_tolerance = std::clamp(wanted, cells.tolerance / (is_known ? 8 : 4), cells.tolerance / 2);
  }
}

}  // namespace v0_1
}  // namespace tessera
