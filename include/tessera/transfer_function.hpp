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

/// Linear RGB colour c(s) and extinction kappa(s) of a scalar s: piecewise linear between knots, clamped outside their
/// range.
///
/// Steps  two knots at one value make a step; the function is right-continuous there: its value is that of the upper
///        (later) knot.
/// Holds  at least one knot, values finite and not decreasing, at most two knots at one value (more are merged to first
///        and last; values less than 2.2e-308 apart are one), colours 0 to 1e30, extinctions 0 to 1e100. A single knot
///        is a constant function.
class TESSERA_EXPORT TransferFunction {
 public:
  TransferFunction() = default;
  /// Throws Error(bad_input) naming the wrong knot (from 1) and number.
  explicit TransferFunction(std::vector<Knot> knots);

  [[nodiscard]] std::span<const Knot> knots() const { return knots_; }

  /// The function's value as a knot at `s`. NaN gives a knot of zeros.
  [[nodiscard]] Knot evaluate(double s) const;

  /// Whether kappa (or, for independent emission, any colour) is positive anywhere in [low, high], ends included.
  [[nodiscard]] bool visible(double low, double high, bool emits_without_extinction = false) const;

  [[nodiscard]] double max_extinction() const;
  [[nodiscard]] double max_color() const;

 private:
  std::vector<Knot> knots_;
  std::vector<std::size_t> visible_knots_before_, emitting_knots_before_;  ///< prefix counts, size knots + 1
};

/// The function as JSON: {"knots": [[value, red, green, blue, extinction], ...]}, its knots unchanged, every double in
/// the shortest form that reads back the same. Dataset::transfer_function() makes the same function from it, bit by
/// bit.
TESSERA_EXPORT std::string transfer_function_json(const TransferFunction& function);

/// The function as ParaView's colour-map JSON, a list of one map, for other programs to read: colours as sRGB,
/// interpolated in RGB, and opacities per unit distance, with additional points between knots where these require them.
/// An image rendered with the function read back differs by less than 5e-4 in linear RGBA. ParaView's form cannot
/// represent two things: colours above 1, which are clamped, and opacities above 1 - 1e-6 per unit distance.
/// `unit_distance` [world units] is reduced until the function stays below that. Throws Error(bad_input) for a function
/// without knots or a length that is not positive.
TESSERA_EXPORT std::string paraview_json(const TransferFunction& function, double unit_distance,
                                         const std::string& name = "Tessera");

/// A transfer function and the origin of its numbers.
struct LoadedTransferFunction {
  TransferFunction function;
  std::string name;                              ///< of the preset or file, with assumptions in brackets
  std::optional<double> unit_distance{};         ///< that was used; none if the file states extinctions
  std::string unit_distance_source;              ///< "file", "`unit_distance`", "default", or "" if they are absolute
  std::optional<std::array<double, 2>> range{};  ///< spanned by the colours, if it was chosen and not the file's
  bool shaded = false;                           ///< Shading is intended: the default function of a patient's scan
  std::vector<std::string> warnings{};  ///< one line each: that it shows little of the field, and how to fix that
};

}  // namespace v0_1
}  // namespace tessera
