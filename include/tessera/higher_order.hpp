// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <optional>

#include "tessera/communicator.hpp"
#include "tessera/dataset.hpp"
#include "tessera/export.hpp"
#include "tessera/settings.hpp"
#include "tessera/transfer_function.hpp"
#include "tessera/view.hpp"

namespace tessera {
inline namespace v0_1 {

/// A mesh whose higher-order cells were divided into tets, and the effect of this approximation on an image.
struct HigherOrderRead {
  Dataset dataset;
  ReadOptions options;  ///< the options with which the mesh was read
  /// The approximate error of a pixel's colour or opacity caused by the division into tets (read_for_accuracy()). 0
  /// without higher-order cells; infinite if some of these cells are drawn as linear cells by their corners.
  double pixel_error = 0;
};

/// The accuracy that `render` and `serve` use by default: half the difference of adjacent values of an 8-bit image.
inline constexpr double default_higher_order_accuracy = 1.0 / 512;

/// The tolerance with which read_for_accuracy() begins. If this tolerance is sufficient, the mesh is read only once.
inline double first_higher_order_tolerance(double accuracy) { return accuracy < 0.1 / 64 ? 64 * accuracy : 0.1; }

/// Reads a mesh with a `higher_order_tolerance` for which the division into tets changes pixels by at most about
/// `accuracy`, and with no more tets than this requires. Without an accuracy the tolerance is that of `options`, and
/// only the error is estimated.
///
/// Method  The mesh is read with decreasing tolerances until its estimated error is small enough. For the estimate, it
///         is read again with a tolerance smaller by a factor r, and images of the view are compared (with at most
///         about 65,536 pixels). r is 4 for up to 65,536 tets and 2 for up to 524,288. If a pixel differs by d, its
///         error is taken to be the larger of 1.5 d r / (r - 1), since errors are in proportion to the tolerance, and
///         d + c. c is the change of the pixel in the finer image if the mesh is moved by its `position_error`
///         parallel to the image: the error of a ray that nearly touches the surface. More tets are compared with
///         those of a tolerance four times larger: the error is the larger of 1.5 d / 3 and c in the own image.
///         If the number of tets does not change by a factor of two, r is larger, up to 64. For transfer functions
///         with steps, the square root of r takes its place.
/// Limits  The result is an estimate for the light of the volume alone, not for surfaces, shading or other views. If
///         `higher_order_tets` allows too few tets, the result is the error of the tets that were made.
///
/// `open` reads the mesh with the given options. `function` and `view` return the transfer function and the view for
/// the data that were read; without `view` the default view of 128 x 128 pixels is used. `settings` supplies emission,
/// threads, memory and ranks. Collective on the ranks of `communicator`, which must be the ranks on which `open` reads.
/// Throws the errors of these functions and of Session.
TESSERA_EXPORT HigherOrderRead read_for_accuracy(const ReadOptions& options, std::optional<double> accuracy,
                                                 const std::function<Dataset(const ReadOptions&)>& open,
                                                 const std::function<TransferFunction(const Dataset&)>& function,
                                                 const std::function<View(const Dataset&)>& view = {},
                                                 const Settings& settings = {}, const Communicator& communicator = {});

}  // namespace v0_1
}  // namespace tessera
