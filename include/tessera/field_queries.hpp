// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <glm/vec3.hpp>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "tessera/communicator.hpp"
#include "tessera/dataset.hpp"
#include "tessera/export.hpp"
#include "tessera/reference.hpp"
#include "tessera/settings.hpp"
#include "tessera/transfer_function.hpp"
#include "tessera/view.hpp"

/// Queries for editors of transfer functions: the distribution of a field's values, and the values along one ray.
namespace tessera {
inline namespace v0_1 {

/// Options of histogram(). Histograms and quantiles are computed from about ten thousand places, spread evenly over the
/// volume; the default transfer function is chosen from the same places. This is fast and gives the same result for any
/// number of threads and ranks. The functions may be called on one rank alone. A share of 1 % of the volume has a
/// relative error of about 10 %. Blank samples and parts left out by a selection are not counted.
struct HistogramOptions {
  std::size_t bins = 256;                        ///< 1 to 65536, of equal width
  std::optional<std::array<double, 2>> range{};  ///< low < high; default: the field's range, or a range of width 1 if
                                                 ///< the field is constant
  /// If true, the bins have equal widths in the logarithm of the value. A range that begins at or below 0 is changed to
  /// begin at the smallest positive value found.
  bool logarithmic = false;
  /// If given, only places inside this view are counted, even if they are hidden.
  std::optional<View> seen{};
};

struct Histogram {
  std::array<double, 2> range{};  ///< from the start of the first bin to the end of the last one
  bool logarithmic = false;
  /// For each bin, the share of the volume whose values are in the bin. The shares sum to 1; all are 0 if the range
  /// contains no values.
  std::vector<double> shares{};
  double outside = 0;  ///< the share of the sampled volume whose values are outside the range
};

/// Throws Error(bad_input) for an invalid range, for logarithms of a field without positive values, or an invalid view.
TESSERA_EXPORT Histogram histogram(const Dataset& dataset, const HistogramOptions& options = {});

/// Returns, for each fraction (0 to 1, in any order), the value below which the field is in that fraction of the
/// volume. The results are NaN if there are no values, as in a view that shows no data. Throws Error(bad_input) for a
/// fraction out of range or an invalid view.
TESSERA_EXPORT std::vector<double> quantiles(const Dataset& dataset, std::span<const double> fractions,
                                             const std::optional<View>& seen = {});

/// A point on a ray.
struct RayPoint {
  double depth = std::numeric_limits<double>::infinity();   ///< planar depth from the eye along the view direction,
                                                            ///< world units
  glm::dvec3 position{0};                                   ///< world
  double value = std::numeric_limits<double>::quiet_NaN();  ///< the field's value; NaN between cells
};

/// The values along the ray through the centre of a pixel, front to back.
struct RayProbe {
  /// The pixel as rendered by Reference; images differ from it by at most Session::promised_error().
  ReferencePixel pixel{};
  /// The point where the ray's opacity begins to grow; its depth is the pixel's depth in the image. None if nothing is
  /// visible.
  std::optional<RayPoint> first{};
  /// The points where the accumulated opacity reaches a hundredth (`front`) and half (`half`) of the pixel's opacity.
  /// If a surface makes the opacity exceed that value, the point is on the surface.
  std::optional<RayPoint> front{}, half{};
  /// Equally spaced depths from where the ray first enters the data to where it last leaves them, both ends included.
  /// Empty if the ray misses the data.
  std::vector<double> depth{};
  std::vector<double> value{};    ///< the field's values at these depths; NaN outside cells and in blank cells
  std::vector<double> opacity{};  ///< the opacity accumulated from the eye to each of these depths
};

/// Returns the values along the ray of a pixel; (0, 0) is the top left. Only the emission, the surfaces and the shading
/// of the settings are used. `samples` is the number of depths in the result, 2 to 65536. For a mesh of 12 million tets
/// the function takes about a tenth of a second.
///
/// For a mesh in parts, one per rank, the function is collective: all ranks call it with the data set's communicator
/// and get the same result. Throws the same errors as Reference, and Error(bad_input) for a pixel outside the image.
TESSERA_EXPORT RayProbe probe(const Dataset& dataset, const View& view, const TransferFunction& transfer_function,
                              PixelIndex pixel, std::size_t samples = 256, const Settings& settings = {},
                              const Communicator& communicator = {});

}  // namespace v0_1
}  // namespace tessera
