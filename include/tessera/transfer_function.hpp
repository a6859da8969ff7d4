// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <glm/vec3.hpp>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "tessera/export.hpp"

namespace tessera {
inline namespace v0_1 {

/// Colour and extinction at one scalar value.
struct Knot {
  double value = 0;       ///< in the field's unit
  glm::dvec3 color{0};    ///< linear RGB, not premultiplied, >= 0
  double extinction = 0;  ///< kappa, 1 / world unit, >= 0
  bool operator==(const Knot&) const = default;
};

/// Linear RGB colour c(s) and extinction kappa(s) for a scalar s, piecewise linear between knots. Outside the range of
/// the knots, the function has the value of the nearest knot.
///
/// Steps  Two knots with the same value make a step. The function is right-continuous there: at the step it has the
///        value of the later knot.
/// Holds  There is at least one knot. Values are finite and do not decrease. At most two knots have the same value: if
///        more knots are given for a value, only the first and the last are kept. Values less than 2.2e-308 apart are
///        the same value. Colours are from 0 to 1e30, extinctions from 0 to 1e100. A single knot is a constant
///        function.
class TESSERA_EXPORT TransferFunction {
 public:
  TransferFunction() = default;
  /// Throws Error(bad_input), which states the knot (counted from 1) and its wrong number, if a knot is invalid.
  explicit TransferFunction(std::vector<Knot> knots);

  [[nodiscard]] std::span<const Knot> knots() const { return knots_; }

  /// Returns colour and extinction at `s` as a knot. If `s` is NaN, all numbers of the knot are zero.
  [[nodiscard]] Knot evaluate(double s) const;

  /// Whether kappa (or, for independent emission, any colour) is positive anywhere in [low, high], ends included.
  [[nodiscard]] bool visible(double low, double high, bool emits_without_extinction = false) const;

  [[nodiscard]] double max_extinction() const;
  [[nodiscard]] double max_color() const;

 private:
  std::vector<Knot> knots_;
  std::vector<std::size_t> visible_knots_before_, emitting_knots_before_;  ///< the number of visible or emitting knots
                                                                           ///< before each knot; one element more than
                                                                           ///< knots
};

/// Returns the function as JSON, {"knots": [[value, red, green, blue, extinction], ...]}, with its knots unchanged and
/// every double in the shortest form that reads back the same. Dataset::transfer_function() makes the same function
/// from the text, bit for bit.
TESSERA_EXPORT std::string transfer_function_json(const TransferFunction& function);

/// Returns the function as a colour map in ParaView's JSON (a list of one map), for other programs: colours are sRGB,
/// interpolated in RGB, and opacities are per unit distance. Points are added between knots where these conversions
/// require them. An image rendered with the function read back differs by less than 5e-4 in linear RGBA. ParaView's
/// form cannot represent two things: colours above 1, which are clamped, and opacities above 1 - 1e-6 per unit
/// distance. `unit_distance` [world units] is reduced until all opacities are below that limit. Throws Error(bad_input)
/// for a function without knots and for a length that is not positive.
TESSERA_EXPORT std::string paraview_json(const TransferFunction& function, double unit_distance,
                                         const std::string& name = "Tessera");

/// A transfer function and the origin of its numbers.
struct LoadedTransferFunction {
  TransferFunction function;
  std::string name;                              ///< name of the preset or file, with assumptions in brackets
  std::optional<double> unit_distance{};         ///< the unit distance that was used; none if the file states
                                                 ///< extinctions
  std::string unit_distance_source;              ///< origin of unit_distance: "file", "`unit_distance`", "default", or
                                                 ///< "" if the file states extinctions
  std::optional<std::array<double, 2>> range{};  ///< range of the colours, if it was chosen and not taken from the file
  bool shaded = false;                           ///< shading is intended, as with the default function for a patient's
                                                 ///< scan
  std::vector<std::string> warnings{};  ///< lines that report that the function shows little of the field, and how to
                                        ///< fix that
};

}  // namespace v0_1
}  // namespace tessera
