// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <vector>

#include "cells/amr/amr_cells.hpp"

namespace tessera::cells {

/// The leaves as they are, `values` one each. One step of the cubes is one of the leaves' lattice.
AmrCubes cubes_of_cells(const AmrLeaves& amr, std::vector<double> values);

/// The leaves with point data: of each part, x first. A corner has the value of the finest part that has it; what cuts
/// through coarser cells takes values between their corners.
AmrCubes cubes_of_points(const AmrLeaves& amr, std::span<const std::vector<double>> points_of_parts);

/// Cell data as a continuous field that has each leaf's value in its centre. Two steps of the cubes are one of the
/// leaves' lattice.
///
/// Where the eight leaves around a corner are of one level, a cube of the dual mesh lies between their centres. The
/// rest, at the boundary and where levels meet, is filled with the leaves' own eighths. Their other corners have the
/// mean of the leaves around them if those are of one level, which at the boundary continues the values outwards; else,
/// at corners of leaves, a mean with weights above 0 for which fields that are linear in space stay so, those of
/// largest entropy (Sukumar, "Construction of polygonal interpolants: a maximum entropy approach", International
/// Journal for Numerical Methods in Engineering 61, 2004), and in the middle of edges and faces that of their corners.
AmrCubes smooth_cubes(const AmrLeaves& amr, std::span<const double> values);

/// Weights above 0 of sum 1 with which offsets have the mean 0 along the axes where they lie on both sides of it. Where
/// there are none such, as in places where levels differ by 3 and more or steps are uneven, some weights are below 0,
/// the squares of all as small as can be; where those would be large, weights above 0 come near. `weights` holds a
/// factor each.
void weigh_by_entropy(std::span<const glm::dvec3> offsets, std::span<double> weights);

}  // namespace tessera::cells
