// How much of a pixel the tets of higher-order cells are off, and how finely that makes them read.
#include "tessera/higher_order.hpp"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include "exchange/collectives.hpp"
#include "frame/communicator.hpp"
#include "frame/dataset.hpp"
#include "tessera/session.hpp"

namespace tessera {
namespace {

/// The steepest slopes of a function, per unit of the field.
struct Slopes {
  double extinction = 0, color = 0;  ///< infinite where it has steps
};

Slopes steepest(std::span<const Knot> knots, const std::array<double, 2>& range) {
  Slopes slopes;
  for (std::size_t k = 0; k + 1 < knots.size(); ++k) {
    const Knot &a = knots[k], &b = knots[k + 1];
    if (b.value < range[0] || a.value > range[1]) continue;
    const double extinction = std::abs(b.extinction - a.extinction);
    const glm::dvec3 apart = glm::abs(b.color - a.color);
    const double color = std::max({apart.x, apart.y, apart.z}), length = b.value - a.value;
    constexpr double infinite = std::numeric_limits<double>::infinity();
    slopes.extinction = std::max(slopes.extinction, extinction == 0 ? 0 : length > 0 ? extinction / length : infinite);
    slopes.color = std::max(slopes.color, color == 0 ? 0 : length > 0 ? color / length : infinite);
  }
  return slopes;
}

}  // namespace

double Dataset::higher_order_error(const TransferFunction& function) const {
  const HigherOrderCells& cells = state_->higher_order;
  if (cells.by_corners > 0) return std::numeric_limits<double>::infinity();
  if (cells.divided == 0) return 0;
  const double chord = glm::length(bounds().high - bounds().low);
  const double extinction = function.max_extinction(), color = std::max(1.0, function.max_color());
  double error = 0;
  if (cells.field_error > 0) {
    const Slopes slopes = steepest(function.knots(), range());
    error += cells.field_error * (slopes.color + color * slopes.extinction * chord);
  }
  // A ray goes in and out through the surface, at 83 degrees eight times as far; with cell data each cell on its way
  // begins and ends elsewhere too.
  const double cells_on_a_ray =
      association() == Association::cell ? 2 * std::cbrt(static_cast<double>(cells.divided)) : 0;
  error += cells.position_error * extinction * color * 16 * (1 + cells_on_a_ray);
  return error;
}

namespace {

/// Tets of one tolerance.
struct Level {
  double tolerance;
  std::uint64_t tets;
  Image picture;  ///< on the rank that assembles it
};

constexpr ImageSize picture_size{128, 128};
constexpr double infinite = std::numeric_limits<double>::infinity();

/// Reads, draws and compares: what read_for_accuracy() does on the way.
class HigherOrderLevels {
 public:
  HigherOrderLevels(const std::function<Dataset(const ReadOptions&)>& open, const ReadOptions& options,
                    const Settings& settings, const Communicator& communicator)
      : open_(open), options_(options), communicator_(communicator) {
    settings_.emission = settings.emission;
    settings_.threads = settings.threads;
    settings_.memory_bytes = settings.memory_bytes;
    settings_.ranks = settings.ranks;
    settings_.ranks.exchange = Exchange::segments;  // the same tolerance for any number of ranks
    settings_.integrator.accuracy = 4e-6;           // of the least that float lanes can do
  }

  void read(double tolerance) {
    data_.reset();  // its memory before the next one's
    options_.higher_order_tolerance = tolerance;
    data_.emplace(open_(options_));
  }

  [[nodiscard]] const Dataset& data() const { return *data_; }
  [[nodiscard]] const HigherOrderCells& cells() const { return data_->higher_order_cells(); }
  /// Whether the limit of tets took the place of the tolerance that was asked for.
  [[nodiscard]] bool is_limited() const { return cells().tolerance > options_.higher_order_tolerance * (1 + 1e-9); }

  /// Draws what was read last. Of fewer than twice the tets of the last picture it takes that one's place: what they
  /// differ by is of a few cells alone.
  void draw(const TransferFunction& function) {
    if (!levels_.empty() && cells().tets < 2 * levels_.back().tets) levels_.pop_back();
    if (!camera_) camera_ = data_->default_camera(picture_size);
    Session session(*data_, settings_, communicator_);
    levels_.push_back({cells().tolerance, cells().tets, session.render({*camera_, picture_size}, function).image});
    if (levels_.size() >= 2) fit();
  }
  [[nodiscard]] std::size_t pictures() const { return levels_.size(); }

  /// Of the last picture; infinite as long as none differ.
  [[nodiscard]] double error() const { return error_; }
  /// Of what was read last.
  [[nodiscard]] double error_of_read() const {
    return levels_.empty() || levels_.back().tets == cells().tets ? error_ : error_at(cells().tolerance);
  }
  [[nodiscard]] double tolerance_for(double error) const { return std::pow(error / factor_, 1 / power_); }

  HigherOrderRead take(double pixel_error) { return {std::move(*data_), options_, pixel_error}; }

 private:
  [[nodiscard]] double error_at(double tolerance) const { return factor_ * std::pow(tolerance, power_); }

  /// How two pictures differ.
  struct Difference {
    double largest = 0, root_mean_square = 0;
  };

  /// p in [1/2, 1] for which errors in proportion to t^p make pictures of tolerances t0 > t1 > t2 differ by d1 and d2.
  static double power_of(double t0, double t1, double t2, double d1, double d2) {
    double low = 0.5, high = 1;  // what falls faster is taken to fall so
    for (int halvings = 0; halvings < 30; ++halvings) {
      const double p = 0.5 * (low + high);
      const bool falls_faster = d1 * (std::pow(t1, p) - std::pow(t2, p)) > d2 * (std::pow(t0, p) - std::pow(t1, p));
      (falls_faster ? low : high) = p;
    }
    return low;
  }

  /// The error as a power of the tolerance, by the last three pictures: of two the power is the least there is.
  void fit() {
    const std::size_t last = levels_.size() - 1;
    const auto differ = [&](std::size_t level) {
      return difference(levels_[level - 1].picture, levels_[level].picture);
    };
    const double t1 = levels_[last - 1].tolerance, t2 = levels_[last].tolerance;
    const Difference d2 = differ(last);
    power_ = 0.5;
    factor_ = error_ = infinite;
    if (!(t1 > t2)) return;
    if (last >= 2) {
      // Rays along the surface show in the largest difference, which depends on a few pixels; the mean is of all.
      const double t0 = levels_[last - 2].tolerance;
      const Difference d1 = differ(last - 1);
      power_ = 0.5 * (power_of(t0, t1, t2, d1.largest, d2.largest) +
                      power_of(t0, t1, t2, d1.root_mean_square, d2.root_mean_square));
    }
    constexpr double other_pixels = 3;
    factor_ = other_pixels * d2.largest / (std::pow(t1, power_) - std::pow(t2, power_));
    error_ = error_at(t2);
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
    const auto transport = communicator_.state().connect();
    return exchange::broadcast_value(*transport, assembler, exchange::MessageKind::higher_order, found);
  }

  const std::function<Dataset(const ReadOptions&)>& open_;
  ReadOptions options_;
  Settings settings_;
  const Communicator& communicator_;
  std::optional<Dataset> data_;
  std::optional<Camera> camera_;
  std::vector<Level> levels_;
  double factor_ = infinite, power_ = 0.5;  ///< error = factor tolerance^power
  double error_ = infinite;
};

}  // namespace

HigherOrderRead read_for_accuracy(const ReadOptions& options, std::optional<double> accuracy,
                                  const std::function<Dataset(const ReadOptions&)>& open,
                                  const std::function<TransferFunction(const Dataset&)>& function_of,
                                  const Settings& settings, const Communicator& communicator) {
  const double aim = accuracy.value_or(options.higher_order_tolerance);
  HigherOrderLevels levels(open, options, settings, communicator);
  std::optional<TransferFunction> first_function;
  constexpr int most_levels = 12;  // cells may be the same tets at several
  double tolerance = first_higher_order_tolerance(aim);
  bool is_last = false;
  for (int level = 1;; ++level) {
    levels.read(tolerance);
    const TransferFunction function = function_of(levels.data());
    if (!first_function) first_function = function;
    const double bound = levels.data().higher_order_error(function);
    is_last = is_last || levels.cells().divided == 0 || (accuracy && bound <= *accuracy) || level == most_levels ||
              (levels.pictures() != 1 && levels.is_limited());
    if (!is_last) {
      levels.draw(*first_function);
      is_last = levels.is_limited() || (accuracy && levels.error() <= *accuracy);
    }
    if (is_last) return levels.take(levels.cells().by_corners > 0 ? bound : std::min(bound, levels.error_of_read()));
    const double wanted =
        accuracy ? std::max(levels.tolerance_for(0.9 * *accuracy), 0.9 * *accuracy / bound * tolerance) : aim;
    const double next = tolerance / (levels.pictures() < 3 ? 4 : 8);
    is_last = wanted >= next;
    tolerance = is_last ? wanted : next;
  }
}

}  // namespace tessera
