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

/// Queries for an editor of transfer functions: the distribution of a field's values, and the values along one ray.
namespace tessera {
inline namespace v0_1 {

/// Histograms and quantiles are taken from some ten thousand places spread evenly over the volume, the same ones by
/// which the default transfer function is chosen. This is fast, gives the same result for any number of threads and
/// ranks, and may be called on any rank alone. A share of 1 % of the volume is correct to about a tenth of itself.
/// Blank samples and parts left out by a selection do not count.
struct HistogramOptions {
  std::size_t bins = 256;                        ///< 1 to 65536, of equal width
  std::optional<std::array<double, 2>> range{};  ///< low < high; default: the field's, or of width 1 if it is constant
  /// Bins of equal width in the logarithm of the value. A range that begins at or below 0 begins at the smallest
  /// positive value found.
  bool logarithmic = false;
  /// Only places inside the view, even if they are hidden.
  std::optional<View> seen{};
};

struct Histogram {
  std::array<double, 2> range{};  ///< from the first bin to the last
  bool logarithmic = false;
  /// The share of the volume with values in each bin. They sum to 1; all are 0 if the range is empty.
  std::vector<double> shares{};
  double outside = 0;  ///< the share of the sampled volume whose values are outside the range
};

/// Throws Error(bad_input) for an invalid range, for logarithms of a field without positive values, or an invalid view.
TESSERA_EXPORT Histogram histogram(const Dataset& dataset, const HistogramOptions& options = {});

/// For each fraction (0 to 1, in any order) the value below which that fraction of the volume is. NaN if there are no
/// values, as in a view that shows no data. Throws Error(bad_input) for a fraction out of range or an invalid view.
TESSERA_EXPORT std::vector<double> quantiles(const Dataset& dataset, std::span<const double> fractions,
                                             const std::optional<View>& seen = {});

/// A point on a ray.
struct RayPoint {
  double depth = std::numeric_limits<double>::infinity();   ///< planar, from the eye along the view direction, world
  glm::dvec3 position{0};                                   ///< world
  double value = std::numeric_limits<double>::quiet_NaN();  ///< of the field; NaN between cells
};

/// The values along the ray through the centre of a pixel, front to back.
struct RayProbe {
  /// The pixel as the reference renders it; images agree with it within Session::promised_error().
  ReferencePixel pixel{};
  /// Where something first becomes visible: its depth is the image's Z. None if nothing is visible.
  std::optional<RayPoint> first{};
  /// Where the opacity reaches a hundredth and half of the pixel's own. If a surface exceeds it, the point is on the
  /// surface.
  std::optional<RayPoint> front{}, half{};
  /// At equal spacing from where the ray first enters the data to where it last leaves them, both ends included; empty
  /// if the ray misses the data.
  std::vector<double> depth{};
  std::vector<double> value{};    ///< of the field at those depths; NaN outside cells and in blank ones
  std::vector<double> opacity{};  ///< accumulated from the eye to those depths
};

/// The ray of a pixel; (0, 0) is the top left. Only the settings that change the image count: emission, surfaces and
/// shading. `samples` along the ray: 2 to 65536. A mesh of 12 million tets takes about a tenth of a second.
///
/// Collective for a mesh in parts, one per rank: all ranks call it with the data set's communicator and get the same
/// result. Throws as Reference, and Error(bad_input) for a pixel outside the image.
TESSERA_EXPORT RayProbe probe(const Dataset& dataset, const View& view, const TransferFunction& transfer_function,
                              PixelIndex pixel, std::size_t samples = 256, const Settings& settings = {},
                              const Communicator& communicator = {});

}  // namespace v0_1
}  // namespace tessera
