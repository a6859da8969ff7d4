// SPDX-License-Identifier: BSD-3-Clause
// Estimates the error of pixels that is due to the tets of higher-order cells, and how finely to divide these.
#include "tessera/higher_order.hpp"

#include <algorithm>
#include <cmath>
#include <glm/vec3.hpp>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include "api/communicator.hpp"
#include "api/dataset.hpp"
#include "exchange/collectives.hpp"
#include "projection/steps.hpp"
#include "tessera/session.hpp"

namespace tessera {
inline namespace v0_1 {
namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();

/// Factor of estimated errors, because a pixel's error varies by chance from one tolerance to the next.
constexpr double margin = 1.5;

/// Returns the view with at most about 65,536 pixels.
View compared(View view) {
  constexpr double most_pixels = 1 << 16;
  const double pixels = static_cast<double>(view.size.width) * view.size.height;
  const double factor = std::min(1.0, std::sqrt(most_pixels / pixels));
  const auto side = [&](int n) { return std::max(1, static_cast<int>(std::lround(n * factor))); };
  view.size = {side(view.size.width), side(view.size.height)};
  return view;
}

/// Returns the view of a mesh that is moved by a vector parallel to the image, world units.
View with_moved_mesh(View view, double right, double up) {
  const ViewBasis basis = view_basis(view.camera);
  const glm::dvec3 by = right * basis.right + up * basis.up;
  view.camera.position -= by;
  view.camera.focal_point -= by;
  return view;
}

/// An image of a mesh's tets. The arrays are empty on ranks that do not assemble the image.
struct Picture {
  std::vector<float> values;  ///< red, green, blue and opacity of each pixel
  std::vector<float> change;  ///< the largest change of each value if the tets are moved by their position error
};

/// Estimates the error of the image of a mesh by comparison with another mesh of the same cells.
class TetComparison {
 public:
  TetComparison(const std::function<Dataset(const ReadOptions&)>& open,
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

  /// Estimates the error of `data`, which were read with `options`; infinite if there is no other mesh to compare.
  double error(const Dataset& data, const ReadOptions& options) {
    const std::optional<double> error = by_finer(data, options);
    return error ? *error : by_coarser(data, options).value_or(infinite);
  }

 private:
  /// Compares few tets with those of a smaller tolerance; no value if `higher_order_tets` does not allow enough tets.
  [[nodiscard]] std::optional<double> by_finer(const Dataset& data, ReadOptions options) {
    constexpr std::uint64_t few = 1 << 16, most = 1 << 19, most_of_finer = 1 << 22;
    constexpr int most_times = 64;
    const HigherOrderCells& cells = data.higher_order_cells();
    if (cells.tets > most) return std::nullopt;
    if (options.higher_order_tets == default_higher_order_tets)
      options.higher_order_tets = std::min(few + 12 * cells.tets, most_of_finer);
    for (int times = cells.tets <= few ? 4 : 2; times <= most_times; times *= 4) {
      options.higher_order_tolerance = cells.tolerance / times;
      const Dataset finer = open_(options);
      const HigherOrderCells& of_finer = finer.higher_order_cells();
      if (of_finer.tolerance > options.higher_order_tolerance * (1 + 1e-9)) return std::nullopt;
      // Cells that hardly bend may need no more tets.
      if (of_finer.tets < 2 * cells.tets && 4 * times <= most_times) continue;
      const Picture picture = draw(data, 0), exact = draw(finer, of_finer.position_error);
      const double rate = rate_of(times);
      return largest(picture, exact, exact.change,
                     [&](double by, double change) { return std::max(margin * by * rate / (rate - 1), by + change); });
    }
    return std::nullopt;
  }

  /// Compares many tets with those of a larger tolerance; no value if these are not fewer.
  [[nodiscard]] std::optional<double> by_coarser(const Dataset& data, ReadOptions options) {
    const HigherOrderCells& cells = data.higher_order_cells();
    std::optional<Dataset> coarser;
    const auto has_half = [&](int times) {
      options.higher_order_tolerance = times * cells.tolerance;
      coarser.emplace(open_(options));
      return 2 * coarser->higher_order_cells().tets <= cells.tets;
    };
    constexpr int most_times = 64;
    if (!has_half(most_times)) return std::nullopt;
    int times = 4;
    while (!has_half(times) && times < most_times) times *= 4;
    const Picture picture = draw(data, cells.position_error), rough = draw(*coarser, 0);
    const double rate = rate_of(times);
    return largest(picture, rough, picture.change,
                   [&](double by, double change) { return std::max(margin * by / (rate - 1), change); });
  }

  /// Returns the factor by which errors decrease if the tolerance is divided by `times`. Rays may nearly touch the
  /// surface at which a function with steps jumps.
  [[nodiscard]] double rate_of(double times) const {
    return projection::has_steps(scene_->second) ? std::sqrt(times) : times;
  }

  [[nodiscard]] Picture draw(const Dataset& data, double position_error) {
    if (!scene_) scene_.emplace(view_ ? compared(view_(data)) : data.default_view({128, 128}), function_(data));
    const auto& [view, function] = *scene_;
    Session session(data, settings_, communicator_);
    Picture picture{session.render(view, function).image.rgba, {}};
    if (position_error == 0) return picture;
    picture.change.resize(picture.values.size());
    const double d = position_error;
    for (const auto& [right, up] : {std::pair{d, 0.0}, {-d, 0.0}, {0.0, d}, {0.0, -d}}) {
      const std::vector<float> values = session.render(with_moved_mesh(view, right, up), function).image.rgba;
      for (std::size_t i = 0; i < values.size(); ++i)
        picture.change[i] = std::max(picture.change[i], std::abs(values[i] - picture.values[i]));
    }
    return picture;
  }

  /// Returns the largest error(difference, change) of the values of two images, the same on all ranks.
  template <class Error>
  [[nodiscard]] double largest(const Picture& a, const Picture& b, const std::vector<float>& change,
                               const Error& error) const {
    const int assembler =
        assign_roles(communicator_.size(), settings_.ranks.projectors, settings_.ranks.compositors).assembler();
    double most = 0;
    for (std::size_t i = 0; i < a.values.size() && communicator_.rank() == assembler; ++i)
      most = std::max(most, error(std::abs(static_cast<double>(a.values[i]) - b.values[i]),
                                  change.empty() ? 0.0 : static_cast<double>(change[i])));
    if (communicator_.size() == 1) return most;
    const auto transport = StateAccess::of(communicator_).connect();
    return exchange::broadcast_value(*transport, assembler, exchange::MessageKind::higher_order, most);
  }

  const std::function<Dataset(const ReadOptions&)>& open_;
  const std::function<TransferFunction(const Dataset&)>& function_;
  const std::function<View(const Dataset&)>& view_;
  Settings settings_;
  const Communicator& communicator_;
  std::optional<std::pair<View, TransferFunction>> scene_;  ///< of the first mesh, used for all
};

}  // namespace

HigherOrderRead read_for_accuracy(const ReadOptions& options, std::optional<double> accuracy,
                                  const std::function<Dataset(const ReadOptions&)>& open,
                                  const std::function<TransferFunction(const Dataset&)>& function,
                                  const std::function<View(const Dataset&)>& view, const Settings& settings,
                                  const Communicator& communicator) {
  TetComparison comparison(open, function, view, settings, communicator);
  constexpr int most_levels = 12;  // several tolerances may give the same tets
  ReadOptions read = options;
  if (accuracy) read.higher_order_tolerance = first_higher_order_tolerance(*accuracy);
  for (int level = 1;; ++level) {
    std::optional<Dataset> data(open(read));
    const HigherOrderCells cells = data->higher_order_cells();
    if (cells.divided == 0) return {std::move(*data), read, cells.by_corners > 0 ? infinite : 0};
    const double error = comparison.error(*data, read);
    const bool is_limited = cells.tolerance > read.higher_order_tolerance * (1 + 1e-9);
    if (!accuracy || is_limited || level == most_levels || error <= *accuracy)
      return {std::move(*data), read, cells.by_corners > 0 ? infinite : error};
    data.reset();  // free its memory before the next data set is read
    // Errors are in proportion to the tolerance or, where rays touch the surface, to its square root; 3/4 is between
    // these. The target is slightly below the requested accuracy, because missing it would cost one more level.
    const double wanted = cells.tolerance * std::pow(0.8 * *accuracy / error, 1 / 0.75);
    read.higher_order_tolerance = std::clamp(wanted, cells.tolerance / 8, cells.tolerance / 2);
  }
}

}  // namespace v0_1
}  // namespace tessera
