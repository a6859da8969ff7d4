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
///           labels    the grid's labels are known: one colour for each, 0 clear, no opacity between them
///           CT        modality CT, or a patient (BodyAxes) without a modality whose values reach from -900 or less to
///                     200 or more, like Hounsfield units: air below -900 clear, lung and fat faint, muscle red, bone
///                     ivory
///           labels    unknown, but all values are integers, and there are 3 to 24 of them or all are within 0 to 63:
///                     one colour for each; 0 is clear in a grid
///           body      another patient (MR): background clear, dark red to ivory values
///           otherwise (`values`): cool-warm
/// Range   of `body` and `values`: between the 0.5 and 99.5 % quantiles of the volume without the background; symmetric
///         about zero if each side of zero extends beyond 0.3 of the other. An end whose distance from zero is at most
///         1e-6 of the range's width becomes zero. Values outside the range have the colours of its ends.
/// Ground  of a grid: if at least a third of the volume has values in one 32nd of the range next to its low end, that
///         end is background, up to where values become rare. It is clear.
/// Opacity each 24th of the range, except the ground, absorbs about the same in total: opacity is proportional to the
///         inverse of the volume with these values, to the power 0.8. It increases by a factor of 3 towards the high
///         end, or, if the range is symmetric about zero, towards both ends.
/// Scale   all opacities are scaled so that the mean opacity of pixels that show anything is 0.4, with at most one
///         pixel in 200 above 0.97, seen along those axes of the box that are normal to its larger faces (PilotPixels).
///         Uses only the samples: no image is rendered.
namespace tessera::colormaps {

enum class DefaultKind { constant, shape, labels, ct, body, values };

struct DefaultField {
  const scene::FieldSamples* samples = nullptr;
  bool is_grid = false;
  bool shape = false;
  BodyAxes axes = BodyAxes::none;
  std::string modality{};  ///< DICOM's modality of a patient's image: CT, MR ...; may be empty
  /// All values of a grid's labels, ascending. Empty: the grid has no labels. No value: it is unknown whether values
  /// are labels, and the samples determine that.
  std::optional<std::vector<double>> labels{};
};

/// The cumulative distribution of values over the volume.
class ValueShares {
 public:
  /// Computes the distribution of the values of the field, or of a grid's stored values (FieldSamples::stored).
  explicit ValueShares(const scene::FieldSamples& samples, bool stored = false);
  [[nodiscard]] bool empty() const { return values_.empty(); }
  /// Returns the value below which the fraction `share` of the volume is, considering only values above `from`.
  [[nodiscard]] double quantile(double share, double from = -1e300) const;
  /// Returns the fraction of the volume with low <= value < high.
  [[nodiscard]] double between(double low, double high) const;
  /// Returns the distinct values if there are at most `most`; otherwise an empty list.
  [[nodiscard]] std::vector<double> distinct(std::size_t most) const;

 private:
  [[nodiscard]] double below(double value) const;
  std::vector<double> values_, sums_;  ///< values_ is ascending; sums_[i] is the fraction of values before i
};

/// Determines the kind of a field.
DefaultKind default_kind(const DefaultField& field, const std::array<double, 2>& range);

/// The range of the kinds `body` and `values`: [low, high], and the end of the ground (low if there is none). `shares`
/// is the distribution of the field's samples.
struct DefaultRange {
  double low = 0, high = 1, ground = 0;
  bool about_zero = false, has_ground = false;
  double ground_share = 0;
};
DefaultRange default_range(const DefaultField& field, const ValueShares& shares, const std::array<double, 2>& range);

/// Returns the function; its name mentions kind and range. `options.opacity_points` replace the opacities described
/// above, `options.range` the range.
LoadedTransferFunction default_function(const DefaultField& field, const TransferFunctionOptions& options);

}  // namespace tessera::colormaps
