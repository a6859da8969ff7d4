// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <vector>

#include "cells/amr/amr_cells.hpp"

namespace tessera::cells {

/// Converts the leaves without changes to cubes with one of `values` each. The lattice of the cubes is that of the
/// leaves.
AmrCubes cubes_of_cells(const AmrLeaves& amr, std::vector<double> values);

/// Converts leaves with point data, which are given for each part, x fastest. A corner has the value of the finest part
/// that contains it. The values at corners inside or on the sides of coarser cells are interpolated from the corners of
/// these cells.
AmrCubes cubes_of_points(const AmrLeaves& amr, std::span<const std::vector<double>> points_of_parts);

/// Converts cell data to a continuous field that has the value of each leaf at the leaf's centre. Two steps of the
/// cubes' lattice are one step of the leaves' lattice.
///
/// Where the eight leaves around a corner have the same level, a cube of the dual mesh connects their centres. The
/// remaining space, at the boundary and between levels, is filled with octants of the leaves. The values at their other
/// corners are computed as follows. If the surrounding leaves have the same level, the value is the mean of the leaves,
/// which continues the values outwards at the boundary. Otherwise, the value at a corner of a leaf is a mean with the
/// positive weights of largest entropy that reproduce linear fields (Sukumar, "Construction of polygonal interpolants:
/// a maximum entropy approach", International Journal for Numerical Methods in Engineering 61, 2004), and the value in
/// the middle of an edge or face is the mean of its corners.
AmrCubes smooth_cubes(const AmrLeaves& amr, std::span<const double> values);

/// Computes positive weights with sum 1 for which the weighted mean of the offsets is 0 along all axes where there are
/// offsets on both sides of 0. Such weights may not exist, for example where levels differ by 3 or more or steps are
/// not uniform. Then some weights are negative and the sum of squares is minimal; if the negative weights were large,
/// positive weights approximate the condition instead. On entry `weights` contains a factor for each offset.
void weigh_by_entropy(std::span<const glm::dvec3> offsets, std::span<double> weights);

}  // namespace tessera::cells
