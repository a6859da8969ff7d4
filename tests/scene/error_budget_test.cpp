// SPDX-License-Identifier: BSD-3-Clause
#include "scene/error_budget.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "scene/error.hpp"

namespace tessera::scene {
namespace {

namespace budget = error_budget;

TEST(ErrorBudget, NoRenderingPathExceedsTheErrorBudget) {
  for (double exponent = -6; exponent <= 0; exponent += 1.0 / 64) {
    const double accuracy = std::max(budget::least_accuracy, std::pow(10, exponent));
    // A mesh is rendered on the lattice and a grid in float lanes if that is accurate enough. Double precision always
    // is.
    EXPECT_LE(budget::mesh_in_double(accuracy), accuracy) << accuracy;
    EXPECT_LE(budget::grid_in_double(accuracy), accuracy) << accuracy;
    EXPECT_LE(budget::deep(accuracy), accuracy) << accuracy;
    for (const bool shaded : {false, true}) {
      const double lattice = budget::mesh_on_lattice(accuracy, 1, shaded);
      const double mesh = lattice <= accuracy ? lattice : budget::mesh_in_double(accuracy);
      if (budget::runs_keep(accuracy, shaded)) {
        EXPECT_LE(mesh + budget::runs, accuracy) << accuracy;
      }
    }
  }
  EXPECT_LE(budget::exact_mesh_on_lattice(1, true) + budget::runs, budget::exact_mesh);
  EXPECT_LE(budget::exact_grid_in_lanes(), budget::exact_grid);
}

TEST(ErrorBudget, DeepImagesAreOnTheLatticeUnlessTheyMustBeVeryAccurate) {
  EXPECT_LE(budget::deep_on_lattice(1e-3, 1, true), 1e-3);
  EXPECT_LE(budget::deep_on_lattice(2.7e-4, 1, true), 2.7e-4);
  EXPECT_GT(budget::deep_on_lattice(2e-4), 2e-4);
  EXPECT_GT(budget::deep_on_lattice(1e-3, 1000), 1e-3);
}

TEST(ErrorBudget, LanesAreForTheDefaultAndFarBelow) {
  EXPECT_LE(budget::mesh_on_lattice(1e-5, 1, true), 1e-5);
  EXPECT_GT(budget::mesh_on_lattice(2e-6), 2e-6);
  EXPECT_LE(budget::grid_in_lanes(1e-5), 1e-5);
  EXPECT_GT(budget::grid_in_lanes(5e-6), 5e-6);
  EXPECT_TRUE(budget::runs_keep(1e-4));
  EXPECT_FALSE(budget::runs_keep(1e-5));
  // For a brightness of 1000, the last place of an image's floats exceeds the budget.
  EXPECT_GT(budget::mesh_on_lattice(1e-4, 1000), 1e-4);
}

TEST(ErrorBudget, LayersLeaveLessToScalarsTheMoreOpaqueTheyAre) {
  // Without opacity: 1.5 times the scalars' share, the lanes and the image.
  EXPECT_NEAR(1.5 * budget::scalars_of_layers(1e-5, 0) + budget::lane_integrals + budget::float_picture, 1e-5, 1e-18);
  double last = 1;
  for (const double threshold : {0.0, 0.1, 0.5, 0.9, 0.99, 0.9999}) {
    const double share = budget::scalars_of_layers(1e-5, threshold);
    EXPECT_GT(share, 0) << threshold;
    EXPECT_LT(share, last) << threshold;
    EXPECT_LT(budget::scalars_of_layers(1e-5, threshold, 1, true), share) << threshold;
    EXPECT_LT(budget::scalars_of_layers(1e-5, threshold, 2), share) << threshold;
    last = share;
  }
  EXPECT_LT(budget::scalars_of_layers(1e-5, 1 - 1e-9), 0);
  EXPECT_LT(budget::scalars_of_layers(1e-6, 0.5), 0);
}

TEST(ErrorBudget, LightOfSurfacesIsAsUncertainAsItsSlope) {
  EXPECT_NEAR(budget::lane_surfaces({0.2, 0.8, 0.2, 32}), 0x1p-20 * (0.8 + 0.2 * 32), 1e-12);
  EXPECT_NEAR(budget::lane_surfaces({0, 0, 1, 0.5}), 0x1p-10, 1e-12);  // the square root of a cosine near zero
  EXPECT_EQ(budget::lane_surfaces({1, 0, 1, 0}), 0);
}

TEST(ErrorBudget, EmissionOnlyLightIsThatOfDenseMatterOrOfTheWholeRay) {
  const TransferFunction dense({{0, {2, 0.5, 0}, 4}, {1, {1, 3, 0}, 1}}), clear({{0, {2, 0, 0}, 0}, {1, {1, 0, 0}, 1}});
  EXPECT_EQ(most_light(dense, Emission::absorption, 100), 3);
  EXPECT_EQ(most_light(dense, Emission::independent, 100), 3);
  EXPECT_EQ(most_light(dense, Emission::independent, 0.5), 1.5);
  EXPECT_EQ(most_light(clear, Emission::independent, 100), 200);
  EXPECT_EQ(most_light(clear, Emission::independent, 0.1), 1);
}

TEST(ErrorBudget, RefusesAnAccuracyBelowThatOfImages) {
  EXPECT_NO_THROW(check_accuracy(1e-6));
  for (const double accuracy : {0.0, -1.0, 9e-7, 1e-9, HUGE_VAL, std::nan("")})
    EXPECT_THROW(check_accuracy(accuracy), Error) << accuracy;
}

}  // namespace
}  // namespace tessera::scene
