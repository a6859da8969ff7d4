// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <vector>

#include "cells/amr/amr_cells.hpp"

namespace tessera::cells {

/// The leaves unchanged, with one of `values` each. The cubes have the leaves' lattice.
AmrCubes cubes_of_cells(const AmrLeaves& amr, std::vector<double> values);

/// The leaves with point data, given per part, x fastest. A corner has the value of the finest part that contains it;
/// corners within coarser cells interpolate the values of their corners.
AmrCubes cubes_of_points(const AmrLeaves& amr, std::span<const std::vector<double>> points_of_parts);

/// Cell data as a continuous field that has each leaf's value at its centre. Two steps of the cubes are one step of the
/// leaves' lattice.
///
/// Where the eight leaves around a corner have one level, a cube of the dual mesh connects their centres. The remaining
/// space, at the boundary and between levels, is filled with octants of the leaves. The other corners of these have the
/// mean of the surrounding leaves if those have one level, which continues the values outwards at the boundary.
/// Otherwise, corners of leaves have a mean with positive weights that reproduce linear fields, those of largest
/// entropy (Sukumar, "Construction of polygonal interpolants: a maximum entropy approach", International Journal for
/// Numerical Methods in Engineering 61, 2004); the middles of edges and faces have the mean of their corners.
AmrCubes smooth_cubes(const AmrLeaves& amr, std::span<const double> values);

/// Computes positive weights with sum 1 for which the offsets have mean 0 along the axes where they are on both sides
/// of 0. If there are none, as in places where levels differ by 3 or more or steps are not uniform, some weights are
/// negative and the sum of squares is minimal; if those were large, positive weights approximate the condition. On
/// entry `weights` holds a factor for each offset.
void weigh_by_entropy(std::span<const glm::dvec3> offsets, std::span<double> weights);

}  // namespace tessera::cells
