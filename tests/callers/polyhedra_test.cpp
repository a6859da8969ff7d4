// SPDX-License-Identifier: BSD-3-Clause
// Polyhedra in a caller's arrays.
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "tessera/tessera.hpp"

namespace tessera {
namespace {

/// A hexahedron over [0, 1]^3 and on it a pyramid given as a polyhedron, with a linear field.
struct House {
  std::vector<double> points = {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0, 0, 0, 1, 1, 0, 1, 1, 1, 1, 0, 1, 1, 0.5, 0.5, 2};
  std::vector<CellType> types = {CellType::hexahedron, CellType::polyhedron};
  std::vector<std::int64_t> offsets = {0, 8, 13}, connectivity = {0, 1, 2, 3, 4, 5, 6, 7, 4, 5, 6, 7, 8};
  std::vector<std::int64_t> faces = {5, 4, 4, 5, 6, 7, 3, 4, 5, 8, 3, 6, 5, 8, 3, 6, 7, 8, 3, 7, 4, 8};
  std::vector<std::int64_t> locations = {-1, 0};
  std::vector<double> scalars;

  House() {
    for (std::size_t v = 0; v < points.size(); v += 3) scalars.push_back(points[v] + points[v + 2]);
  }
  [[nodiscard]] MeshArrays arrays() const {
    MeshArrays arrays;
    arrays.points = points, arrays.types = types, arrays.offsets = offsets, arrays.connectivity = connectivity;
    arrays.faces = faces, arrays.face_locations = locations, arrays.scalars = scalars;
    return arrays;
  }
  [[nodiscard]] std::string fault() const {
    try {
      static_cast<void>(Dataset::of(arrays()));
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::bad_input);
      return error.what();
    }
    return "";
  }
};

TEST(CallersPolyhedra, AreRenderedAsTheCellsTheyAre) {
  const House house;
  const Dataset data = Dataset::of(house.arrays());
  EXPECT_EQ(data.mesh_counts().cells_polyhedra, 1u);
  EXPECT_TRUE(data.warnings().empty());
  EXPECT_TRUE(data.check().clean());
  House native;
  native.types[1] = CellType::pyramid;
  native.faces.clear(), native.locations.clear();
  const Dataset same = Dataset::of(native.arrays());
  EXPECT_EQ(data.tet_count(), same.tet_count());
  const View view = data.default_view({48, 40});
  const TransferFunction function = data.transfer_function().function;
  EXPECT_EQ(Session(data).render(view, function).image.rgba, Session(same).render(view, function).image.rgba);
}

TEST(CallersPolyhedra, OmitsOpenPolyhedraWithAWarning) {
  House house;
  house.faces[0] = 4;
  const Dataset data = Dataset::of(house.arrays());
  EXPECT_EQ(data.mesh_counts().cells_open, 1u);
  ASSERT_EQ(data.warnings().size(), 1u);
  EXPECT_NE(data.warnings()[0].find("1 polyhedra are left out"), std::string::npos);
}

TEST(CallersPolyhedra, RefusesInvalidFacesWithTheirPlace) {
  House house;
  house.faces[4] = 9;
  EXPECT_NE(house.fault().find("mesh: cell 1 is a polyhedron with point 9 in a face, but there are only 9 points"),
            std::string::npos)
      << house.fault();
  house = House(), house.faces[0] = 6;
  EXPECT_NE(house.fault().find("mesh: cell 1 is a polyhedron with 6 faces, whose lists end after"), std::string::npos);
  house = House(), house.faces[5] = -1;
  EXPECT_NE(house.fault().find("mesh: number of faces 5 is -1"), std::string::npos);
  house = House(), house.locations[1] = 22;
  EXPECT_NE(house.fault().find("mesh: face location 1 is 22; it must be -1 to 21"), std::string::npos);
  house = House(), house.locations.pop_back();
  EXPECT_NE(house.fault().find("mesh: there are 1 face locations for 2 cells"), std::string::npos);
  house = House(), house.faces.clear();
  EXPECT_NE(house.fault().find("2 face locations for 2 cells and 0 numbers of faces"), std::string::npos);
  house = House(), house.locations[1] = -1;
  EXPECT_NE(house.fault().find("cell 1 is a polyhedron without a list of its faces"), std::string::npos);
  house = House(), house.types[0] = CellType::polyhedron, house.locations[0] = 0;
  EXPECT_NE(house.fault().find("mesh: cell 1 is a polyhedron that has faces of another cell"), std::string::npos);
  MeshArrays tets;
  const std::vector<std::uint32_t> corners = {0, 1, 2, 4};
  tets.points = house.points, tets.tets = corners, tets.scalars = house.scalars, tets.faces = house.faces;
  EXPECT_THROW(static_cast<void>(Dataset::of(tets)), Error);
}

}  // namespace
}  // namespace tessera
