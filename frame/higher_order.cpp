// How much of a pixel the tets of higher-order cells may be off, and what to read instead.
#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>

#include "frame/dataset.hpp"
#include "scene/mesh_facts.hpp"

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

std::optional<ReadOptions> finer_read(const ReadOptions& options, const Dataset& data, const TransferFunction& function,
                                      double accuracy) {
  const HigherOrderCells& cells = data.higher_order_cells();
  const double error = data.higher_order_error(function);
  const bool is_as_asked = cells.tolerance <= options.higher_order_tolerance * (1 + 1e-9);
  if (cells.divided == 0 || !is_as_asked || !(error > accuracy) || !std::isfinite(error)) return std::nullopt;
  ReadOptions finer = options;
  finer.higher_order_tolerance *= 0.9 * accuracy / error;  // a little less, for the range and the bound move with it
  return finer;
}

}  // namespace tessera
