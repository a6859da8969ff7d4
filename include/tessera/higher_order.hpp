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

/// A mesh whose higher-order cells became tets, and what these change in a picture.
struct HigherOrderRead {
  Dataset dataset;
  ReadOptions options;  ///< that it was read with
  /// About how far a pixel's color or opacity is off because of the tets: see read_for_accuracy(). 0 without
  /// higher-order cells, infinite if some are drawn by their corners.
  double pixel_error = 0;
};

/// The accuracy that `render` and `serve` use if none is given: half a step of an 8-bit picture.
inline constexpr double default_higher_order_accuracy = 1.0 / 512;

/// The tolerance that read_for_accuracy() begins with: a mesh read so is not read twice.
inline double first_higher_order_tolerance(double accuracy) { return accuracy < 0.1 / 64 ? 64 * accuracy : 0.1; }

/// Reads a mesh with a `higher_order_tolerance` for which its tets change pixels by about `accuracy` at most, and with
/// no more tets than that takes. Without an accuracy the tolerance is that of `options`, and only the error is found.
///
/// Method  The mesh is read with smaller and smaller tolerances, and pictures of the view, of tolerances four times
///         apart or more, are compared: of its own pixels, or of 65,536 if it has more. How they differ in the mean
///         gives how the error falls, in proportion to the tolerance, or to its square root where many rays touch the
///         surface; so the largest difference gives the error. 1.75 times that is stated, since a pixel's error varies
///         by chance from one tolerance to the next. Of two pictures alone it is taken to fall the slower way.
/// Limits  It is an estimate, of the volume's light alone: not of surfaces and shading, nor of other views. Where
///         `higher_order_tets` allows too few, it is that of the tets that there are.
///
/// `open` reads the mesh with other options; `function` gives the transfer function, and `view` the view, of what was
/// read; without one it is the default view of 128 x 128 pixels. Collective on the ranks of `communicator`, which must
/// be those of `open`; `settings` gives emission, threads, memory and ranks. Throws what these functions throw, and as
/// Session.
TESSERA_EXPORT HigherOrderRead read_for_accuracy(const ReadOptions& options, std::optional<double> accuracy,
                                                 const std::function<Dataset(const ReadOptions&)>& open,
                                                 const std::function<TransferFunction(const Dataset&)>& function,
                                                 const std::function<View(const Dataset&)>& view = {},
                                                 const Settings& settings = {}, const Communicator& communicator = {});

}  // namespace v0_1
}  // namespace tessera
