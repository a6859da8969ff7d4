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

/// A mesh whose higher-order cells were divided into tets, and the effect of that on an image.
struct HigherOrderRead {
  Dataset dataset;
  ReadOptions options;  ///< with which it was read
  /// The approximate error of a pixel's colour or opacity that is due to the tets: see read_for_accuracy(). 0 without
  /// higher-order cells, infinite if some are drawn by their corners.
  double pixel_error = 0;
};

/// The accuracy that `render` and `serve` use by default: half a step of an 8-bit image.
inline constexpr double default_higher_order_accuracy = 1.0 / 512;

/// The tolerance that read_for_accuracy() begins with: a mesh read with this tolerance is not read twice.
inline double first_higher_order_tolerance(double accuracy) { return accuracy < 0.1 / 64 ? 64 * accuracy : 0.1; }

/// Reads a mesh with a `higher_order_tolerance` for which its tets change pixels by at most about `accuracy`, with no
/// more tets than that requires. Without an accuracy the tolerance is that of `options`, and only the error is
/// estimated.
///
/// Method  The mesh is read with smaller and smaller tolerances. Images of the view (with its own pixels, or 65,536 if
///         it has more) whose tolerances differ by a factor of four or more are compared. Their mean difference gives
///         the rate at which the error falls: between the tolerance itself and, where many rays touch the surface, its
///         square root. The largest difference then gives the error; 1.75 times that is reported, since a pixel's error
///         varies by chance from one tolerance to the next. With only two images the slower rate is assumed.
/// Limits  The result is an estimate for the light of the volume alone, not for surfaces, shading or other views. If
///         `higher_order_tets` allows too few tets, it is the error of the tets that were made.
///
/// `open` reads the mesh with other options; `function` and `view` return the transfer function and the view for the
/// data that were read; without `view` it is the default view of 128 x 128 pixels. Collective on the ranks of
/// `communicator`, which must be those of `open`; `settings` supplies emission, threads, memory and ranks. Throws
/// whatever these functions throw, and as Session.
TESSERA_EXPORT HigherOrderRead read_for_accuracy(const ReadOptions& options, std::optional<double> accuracy,
                                                 const std::function<Dataset(const ReadOptions&)>& open,
                                                 const std::function<TransferFunction(const Dataset&)>& function,
                                                 const std::function<View(const Dataset&)>& view = {},
                                                 const Settings& settings = {}, const Communicator& communicator = {});

}  // namespace v0_1
}  // namespace tessera
