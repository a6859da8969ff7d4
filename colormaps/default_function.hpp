// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "colormaps/function_options.hpp"
#include "scene/field_samples.hpp"
#include "tessera/default_view.hpp"

/// The transfer function of a picture that nobody asked for one, from how the field's values share the volume.
///
/// Kind    the first that fits:
///           constant  one value: the colour of the middle, opacity 0.1
///           shape     a mesh without a field (ReadOptions::shape): thick fog, near parts light, far ones dark
///           labels    the grid's are known: a colour each, 0 clear, no opacity between them
///           CT        of modality CT, or of a patient (BodyAxes) without one, values from -900 or less to 200 or more,
///           as Hounsfield's: air
///                     below -900 clear, lung and fat faint, muscle red, bone ivory
///           labels    not known whether they are: all values whole numbers, 3 to 24 of them or all within 0 to 63: a
///           colour each, 0 of a grid body      another patient (MR): background clear, dark red to ivory values
///           anything else: cool-warm
/// Range   of body and values: what lies between 0.5 and 99.5 % of the volume, background apart; about zero, as much
///         below as above it, if both sides reach beyond 0.3 of the other. An end within 1e-6 of
///         the range's width from zero is zero. Values outside have the ends' colour.
/// Ground  of a grid: if a third of the volume or more lies in one 32nd of the range next to its low end, that end is
///         background, up to where values get rare. It is clear.
/// Opacity each 24th of the range, bar the ground, absorbs about as much in all: so it is in proportion to the inverse
///         of the volume that has these values, to the power 0.8. It rises to the high end (about zero: to both) by a
///         factor of 3.
/// Scale   all opacities are scaled so that pixels that show anything are 0.4 opaque in the mean, seen along those of
///         the box's axes across which its larger faces lie, with at most one in 200 above 0.97 (PilotPixels). By the
///         samples alone: no picture is made.
namespace tessera::colormaps {

enum class DefaultKind { constant, shape, labels, ct, body, values };

struct DefaultField {
  const scene::FieldSamples* samples = nullptr;
  bool is_grid = false;
  bool shape = false;
  BodyAxes axes = BodyAxes::none;
  std::string modality{};  ///< of a patient's picture, as DICOM says it: CT, MR ...; may be empty
  /// All values of a grid's labels, ascending; empty: they are no labels; none: by the samples.
  std::optional<std::vector<double>> labels{};
};

/// What is needed of the volume's distribution: values with all that lies below.
class ValueShares {
 public:
  /// Of the field, or of a grid's values themselves (FieldSamples::stored).
  explicit ValueShares(const scene::FieldSamples& samples, bool stored = false);
  [[nodiscard]] bool empty() const { return values_.empty(); }
  /// The value below which `share` of the volume lies, of what is above `from`.
  [[nodiscard]] double quantile(double share, double from = -1e300) const;
  /// Share of the volume with low <= value < high.
  [[nodiscard]] double between(double low, double high) const;
  /// Distinct values, if at most so many; else empty.
  [[nodiscard]] std::vector<double> distinct(std::size_t most) const;

 private:
  [[nodiscard]] double below(double value) const;
  std::vector<double> values_, sums_;  ///< ascending; sums_[i]: share of values before i
};

/// Which kind a field is of.
DefaultKind default_kind(const DefaultField& field, const std::array<double, 2>& range);

/// Range of body and values: [low, high], and where the ground ends (low if there is none). `shares` of its samples.
struct DefaultRange {
  double low = 0, high = 1, ground = 0;
  bool about_zero = false, has_ground = false;
  double ground_share = 0;
};
DefaultRange default_range(const DefaultField& field, const ValueShares& shares, const std::array<double, 2>& range);

/// The function; its name says kind and range. With `options.opacity_points` these instead of the opacities above; with
/// `options.range` that range.
LoadedTransferFunction default_function(const DefaultField& field, const TransferFunctionOptions& options);

}  // namespace tessera::colormaps
