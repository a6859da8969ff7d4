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
/// Method  The mesh is read with decreasing tolerances, and an image of the view is rendered for each (with 16
///         times its pixels, but at most about 65,536). Images are compared if their tolerances differ by a factor of
///         four or more. The mean difference of two images gives the rate at which the error decreases: in proportion
///         to the tolerance or, where many rays touch the surface, as slowly as its square root. The largest difference
///         of pixels then gives the error. 1.75 times this error is reported, since a pixel's error varies by chance
///         from one tolerance to the next. If there are only two images, the slower rate is assumed. A mesh of up to
///         65,536 tets is instead compared with a finer one: its tolerance is divided by 4, 16 or 64, until the number
///         of tets is at least doubled, and twice the largest difference of the images is reported. For single cells
///         with curved faces, the result is about four times the largest error of a pixel.
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
