// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <optional>
#include <span>
#include <vector>

#include "scene/lattice.hpp"
#include "scene/transfer_function.hpp"

/// Transfer functions that are too steep for the lattice in small ranges of scalars, for example functions of the
/// logarithm of a value. These ranges are magnified (scene::MagnifiedRange).
namespace tessera::frame {

/// A piece of the function between two knots.
struct FunctionPiece {
  double low, high;
  double change;    ///< largest change of a pixel if a scalar on the whole ray moves from `low` to `high`
  bool step_above;  ///< whether the function steps at `high`
};

/// The scalars of a frame's lattice: all scalars of the mesh and of the knots inside their range are within `reach` of
/// the lattice's origin.
struct ScalarLattice {
  scene::Lattice lattice;
  double reach;

  /// Sets the lattice's origin and unit.
  void place(double origin, double new_reach);
  /// Whether the errors of scalars in the piece change a pixel by at most `most_error`.
  [[nodiscard]] bool resolves(const FunctionPiece& piece, double most_error) const;
};

/// The lattice of a frame, and the transfer function of its scalars: knots in magnified ranges are moved.
struct FrameLattice {
  scene::Lattice lattice;
  scene::TransferFunction function;
  std::vector<scene::MagnifiedRange> magnified{};
};

/// Returns a lattice of scalars from `range` (lowest, highest) on which magnified ranges contain all pieces, ascending,
/// that the lattice would not resolve. Returns nothing if more than eight ranges would be needed.
std::optional<FrameLattice> magnify(ScalarLattice scalars, const std::array<double, 2>& range,
                                    std::span<const FunctionPiece> pieces, double most_error,
                                    const scene::TransferFunction& function);

}  // namespace tessera::frame
