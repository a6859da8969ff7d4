// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "colormaps/function_options.hpp"
#include "scene/field_samples.hpp"
#include "tessera/default_view.hpp"

/// The default transfer function, chosen by the distribution of the field's values over the volume.
///
/// Kind    the first that applies:
///           constant  one value: the colour of the middle, opacity 0.1
///           shape     a mesh without a field (ReadOptions::shape): thick fog, near parts light, far ones dark
///           labels    the grid's labels are known: a colour each, 0 clear, no opacity between them
///           CT        modality CT, or a patient (BodyAxes) without a modality whose values reach from -900 or less to
///                     200 or more, like Hounsfield units: air below -900 clear, lung and fat faint, muscle red, bone
///                     ivory
///           labels    unknown, but all values are integers, 3 to 24 of them or all within 0 to 63: a colour each, 0 of
///                     a grid clear
///           body      another patient (MR): background clear, dark red to ivory values
///           otherwise cool-warm
/// Range   of body and values: between the 0.5 and 99.5 % quantiles of the volume without the background; symmetric
///         about zero if both sides reach beyond 0.3 of the other. An end within 1e-6 of the range's width from zero
///         becomes zero. Values outside have the ends' colour.
/// Ground  of a grid: if at least a third of the volume is in one 32nd of the range next to its low end, that end is
///         background, up to where values become rare. It is clear.
/// Opacity each 24th of the range, except the ground, absorbs about the same in total: opacity is proportional to the
///         inverse of the volume with these values, to the power 0.8. It increases towards the high end (about zero:
///         towards both) by a factor of 3.
/// Scale   all opacities are scaled so that the mean opacity of pixels that show anything is 0.4, seen along those of
///         the box's axes that are normal to its larger faces, with at most one pixel in 200 above 0.97 (PilotPixels).
///         Uses only the samples: no image is rendered.
namespace tessera::colormaps {

enum class DefaultKind { constant, shape, labels, ct, body, values };

struct DefaultField {
  const scene::FieldSamples* samples = nullptr;
  bool is_grid = false;
  bool shape = false;
  BodyAxes axes = BodyAxes::none;
  std::string modality{};  ///< DICOM's modality of a patient's image: CT, MR ...; may be empty
  /// All values of a grid's labels, ascending; empty: not labels; no value: unknown, the samples decide.
  std::optional<std::vector<double>> labels{};
};

/// The cumulative distribution of values over the volume.
class ValueShares {
 public:
  /// Of the field, or of a grid's stored values (FieldSamples::stored).
  explicit ValueShares(const scene::FieldSamples& samples, bool stored = false);
  [[nodiscard]] bool empty() const { return values_.empty(); }
  /// The value below which the fraction `share` of the volume is, considering only values above `from`.
  [[nodiscard]] double quantile(double share, double from = -1e300) const;
  /// Fraction of the volume with low <= value < high.
  [[nodiscard]] double between(double low, double high) const;
  /// Distinct values, if there are at most `most`; else empty.
  [[nodiscard]] std::vector<double> distinct(std::size_t most) const;

 private:
  [[nodiscard]] double below(double value) const;
  std::vector<double> values_, sums_;  ///< ascending; sums_[i]: fraction of values before i
};

/// The kind of a field.
DefaultKind default_kind(const DefaultField& field, const std::array<double, 2>& range);

/// Range of body and values: [low, high], and the end of the ground (low if there is none). `shares` of its samples.
struct DefaultRange {
  double low = 0, high = 1, ground = 0;
  bool about_zero = false, has_ground = false;
  double ground_share = 0;
};
DefaultRange default_range(const DefaultField& field, const ValueShares& shares, const std::array<double, 2>& range);

/// The function; its name mentions kind and range. `options.opacity_points` replace the opacities above,
/// `options.range` the range.
LoadedTransferFunction default_function(const DefaultField& field, const TransferFunctionOptions& options);

}  // namespace tessera::colormaps
