// SPDX-License-Identifier: BSD-3-Clause
#include "tessera/program/nearest_name.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace tessera::scene {
namespace {

TEST(NearestName, IsTheOneThatWasMeant) {
  const std::vector<std::string> names = {"pressure", "Temperature", "fluid/internalMesh", "p", "velocity"};
  EXPECT_EQ(nearest_name("presure", names), "pressure");
  EXPECT_EQ(nearest_name("PRESSURE", names), "pressure");
  EXPECT_EQ(nearest_name("temperatuer", names), "Temperature");
  EXPECT_EQ(nearest_name("internalmesh", names), "fluid/internalMesh");
  EXPECT_EQ(nearest_name("velcoity", names), "velocity");  // swapped letters count as one change
  EXPECT_EQ(nearest_name("P", names), "p");
}

TEST(NearestName, IsEmptyIfNoNameIsSimilar) {
  const std::vector<std::string> names = {"pressure", "Temperature"};
  EXPECT_EQ(nearest_name("density", names), std::nullopt);
  EXPECT_EQ(nearest_name("", names), std::nullopt);
  EXPECT_EQ(nearest_name("x", names), std::nullopt);
  EXPECT_EQ(nearest_name("pressure", {}), std::nullopt);
  EXPECT_EQ(nearest_name(std::string(5000, 'a'), std::vector<std::string>{std::string(7000, 'b')}), std::nullopt);
}

}  // namespace
}  // namespace tessera::scene
