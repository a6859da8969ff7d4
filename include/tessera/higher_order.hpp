#pragma once

#include <functional>
#include <optional>

#include "tessera/communicator.hpp"
#include "tessera/dataset.hpp"
#include "tessera/export.hpp"
#include "tessera/settings.hpp"
#include "tessera/transfer_function.hpp"

namespace tessera {

/// A mesh whose higher-order cells became tets, and what these change in a picture.
struct HigherOrderRead {
  Dataset dataset;
  ReadOptions options;  ///< that it was read with
  /// About how far a pixel's color or opacity is off because of the tets: see read_for_accuracy(). 0 without
  /// higher-order cells, infinite if some are drawn by their corners.
  double pixel_error = 0;
};

/// The tolerance that read_for_accuracy() begins with: a mesh read so is not read twice.
inline double first_higher_order_tolerance(double accuracy) { return accuracy < 0.1 / 64 ? 64 * accuracy : 0.1; }

/// Reads a mesh with a `higher_order_tolerance` for which its tets change pixels by about `accuracy` at most, and with
/// no more tets than that takes. Without an accuracy the tolerance is that of `options`, and only the error is found.
///
/// Method  The mesh is read with 64 times the tolerance, then with smaller ones, and pictures of the tets, 128 x 128
///         pixels from the default view, are compared. How they differ gives the error and how it falls: in proportion
///         to the tolerance, or to its square root where rays touch the surface; the power that is taken lies midway
///         between those of the largest and of the root mean square difference. The error that is stated is three
///         times the largest, since other pixels and views may be off by more. Dataset::higher_order_error(), a bound
///         for all rays and mostly far above the error, ends the search sooner where it is small enough.
/// Limits  It is an estimate, of the volume's light alone: not of surfaces and shading, nor of rays along the mesh's
///         surface in other views. Where `higher_order_tets` allows too few, it is that of the tets that there are.
///
/// `open` reads the mesh with other options; `function` gives the transfer function of what was read. Collective on the
/// ranks of `communicator`, which must be those of `open`; `settings` gives emission, threads, memory and ranks. Throws
/// what `open` and `function` throw, and as Session.
TESSERA_EXPORT HigherOrderRead read_for_accuracy(const ReadOptions& options, std::optional<double> accuracy,
                                                 const std::function<Dataset(const ReadOptions&)>& open,
                                                 const std::function<TransferFunction(const Dataset&)>& function,
                                                 const Settings& settings = {}, const Communicator& communicator = {});

}  // namespace tessera
