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

/// What an editor of transfer functions asks of a field: how its values share the volume, and what one ray meets.
namespace tessera {
inline namespace v0_1 {

/// Histograms and quantiles are of some ten thousand places spread evenly over the volume, those by which the default
/// transfer function is chosen: quick, the same for any number of threads and ranks, and to be called on any rank
/// alone. A share of the volume of 1 % comes out right to about a tenth of itself. Blank samples and what a selection
/// leaves out do not count.
struct HistogramOptions {
  std::size_t bins = 256;                        ///< 1 to 65536, of equal width
  std::optional<std::array<double, 2>> range{};  ///< low < high; default: the field's; of one value a unit round it
  /// Bins of equal width in the value's logarithm. A range that begins at 0 or below begins at the smallest positive
  /// value found.
  bool logarithmic = false;
  /// Only what lies in the picture of this view, whatever hides it.
  std::optional<View> seen{};
};

struct Histogram {
  std::array<double, 2> range{};  ///< from the first bin to the last
  bool logarithmic = false;
  /// By bin, the share of the volume with values in it. They sum to 1; all 0 if the range holds nothing.
  std::vector<double> shares{};
  double outside = 0;  ///< the share of all the volume looked at whose values are not in the range
};

/// Throws Error(bad_input) for a range that is none, for logarithms of a field without positive values, or an invalid
/// view.
TESSERA_EXPORT Histogram histogram(const Dataset& dataset, const HistogramOptions& options = {});

/// For each fraction (0 to 1, in any order) the value that so much of the volume lies below. Of nothing, as of a view
/// that shows no data, NaN. Throws Error(bad_input) for a fraction out of range or an invalid view.
TESSERA_EXPORT std::vector<double> quantiles(const Dataset& dataset, std::span<const double> fractions,
                                             const std::optional<View>& seen = {});

/// A place on a ray.
struct RayPoint {
  double depth = std::numeric_limits<double>::infinity();   ///< planar, from the eye along the view's direction, world
  glm::dvec3 position{0};                                   ///< world
  double value = std::numeric_limits<double>::quiet_NaN();  ///< of the field; NaN between cells
};

/// What the ray through the middle of a pixel meets, front to back.
struct RayProbe {
  /// The pixel as the reference renders it, which pictures keep to (Session::promised_error()).
  ReferencePixel pixel{};
  /// Where something is first visible: its depth is the picture's Z. None where nothing is.
  std::optional<RayPoint> first{};
  /// Where the opacity reaches a hundredth and half of the pixel's own. Where a surface takes it beyond, on that.
  std::optional<RayPoint> front{}, half{};
  /// At even depths from where the ray enters the data to where it leaves them for the last time, both ends included;
  /// empty if it does not meet them.
  std::vector<double> depth{};
  std::vector<double> value{};    ///< of the field at those depths; NaN where there is no cell, or a blank one
  std::vector<double> opacity{};  ///< of all from the eye up to those depths
};

/// The ray of a pixel; (0, 0) is the top left. Of the settings those count that change what is seen: emission, surfaces
/// and shading. `samples` along the ray: 2 to 65536. A mesh of 12 million tets takes about a tenth of a second.
///
/// Of a mesh in parts, one a rank, collective: all ranks call it, with the data set's communicator, and get the same.
/// Throws as Reference, and Error(bad_input) for a pixel outside of the picture.
TESSERA_EXPORT RayProbe probe(const Dataset& dataset, const View& view, const TransferFunction& transfer_function,
                              PixelIndex pixel, std::size_t samples = 256, const Settings& settings = {},
                              const Communicator& communicator = {});

}  // namespace v0_1
}  // namespace tessera
