// SPDX-License-Identifier: BSD-3-Clause
// Axes of NetCDF grids by the CF conventions: every order of dimensions, every direction, and other dimensions.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <string>
#include <vector>

#include "readers/netcdf_writer.hpp"
#include "support/read_files.hpp"
#include "support/some_cases.hpp"
#include "support/temporary_folder.hpp"
#include "support/volume_checks.hpp"

namespace tessera::io::netcdf_axes_test {
namespace {

using test::has_note;
using test::NetcdfWriter;

using Texts = std::vector<std::pair<const char*, const char*>>;

/// An axis of a file: its name, attributes and coordinates.
struct AxisOfFile {
  const char* name;
  Texts attributes;
  std::vector<double> coordinates;
};

constexpr std::array<std::size_t, 3> marked = {3, 1, 0};  // along x, y and z, in the order of the coordinates

/// A grid whose dimensions are in the order of the file, the first the slowest: 1 at the marked sample, else 0.
void write_marked(const std::filesystem::path& file, const std::array<AxisOfFile, 3>& axes,
                  const std::array<std::size_t, 3>& order) {
  NetcdfWriter w(file, NC_NETCDF4);
  std::array<int, 3> dimensions{}, variables{};
  for (std::size_t a = 0; a < 3; ++a) {
    dimensions[a] = w.dimension(axes[a].name, axes[a].coordinates.size());
    variables[a] = w.variable(axes[a].name, NC_DOUBLE, {dimensions[a]});
    for (const auto& [name, value] : axes[a].attributes) w.text(variables[a], name, value);
  }
  const int field = w.variable("marker", NC_FLOAT, {dimensions[order[0]], dimensions[order[1]], dimensions[order[2]]});
  w.end_definitions();
  std::size_t at = 0, count = 1;
  for (const std::size_t a : order) {
    at = at * axes[a].coordinates.size() + marked[a];
    count *= axes[a].coordinates.size();
  }
  std::vector<double> values(count, 0);
  values[at] = 1;
  w.put(field, values);
  for (std::size_t a = 0; a < 3; ++a) w.put(variables[a], axes[a].coordinates);
}

/// Position of the largest sample.
glm::dvec3 place_of_marker(const VolumeFile& volume) {
  const std::vector<double> samples = test::all_samples(*volume.source);
  const auto at = static_cast<std::int64_t>(std::max_element(samples.begin(), samples.end()) - samples.begin());
  const scene::GridIndex n = volume.source->geometry().samples();
  return scene::world_of_index(volume.source->geometry(), {at % n[0], at / n[0] % n[1], at / (n[0] * n[1])});
}

const AxisOfFile longitude{"lon", {{"units", "degrees_east"}}, {10, 20, 30, 40, 50}};
const AxisOfFile latitude{"lat", {{"units", "degrees_north"}}, {-30, 0, 30, 60}};
const AxisOfFile height{"h", {{"units", "m"}, {"positive", "up"}}, {100, 500, 1000}};

TEST(NetcdfAxes, FollowTheirAttributesInEveryOrderAndDirection) {
  const test::TemporaryFolder folder;
  const auto file = folder / "marked.nc";
  std::array<std::size_t, 3> order = {0, 1, 2};
  test::SomeCases some(5);
  do {
    for (unsigned falling = 0; falling < 8; ++falling)
      for (const bool down : {false, true}) {
        if (!some.next()) continue;
        SCOPED_TRACE(::testing::Message()
                     << order[0] << order[1] << order[2] << " falling " << falling << " down " << down);
        std::array<AxisOfFile, 3> axes = {longitude, latitude, height};
        if (down) axes[2].attributes[1].second = "down";
        for (unsigned a = 0; a < 3; ++a)
          if ((falling >> a & 1) != 0) std::reverse(axes[a].coordinates.begin(), axes[a].coordinates.end());
        write_marked(file, axes, order);
        const VolumeFile volume = open_volume(file);
        EXPECT_EQ(volume.source->geometry().points, (scene::GridIndex{5, 4, 3}));
        const double z = axes[2].coordinates[marked[2]];
        EXPECT_EQ(place_of_marker(volume),
                  glm::dvec3(axes[0].coordinates[marked[0]], axes[1].coordinates[marked[1]], down ? -z : z));
        EXPECT_EQ(has_note(volume, "increases downwards"), down);
      }
  } while (std::next_permutation(order.begin(), order.end()));
}

TEST(NetcdfAxes, AreKnownByAnyOfTheirAttributesOrTheirNames) {
  const test::TemporaryFolder folder;
  const auto file = folder / "marked.nc";
  const std::vector<std::array<std::pair<const char*, Texts>, 3>> cases = {
      {{{"a", {{"axis", "X"}}}, {"b", {{"axis", "Y"}}}, {"c", {{"axis", "Z"}}}}},
      {{{"a", {{"_CoordinateAxisType", "GeoX"}}},
        {"b", {{"_CoordinateAxisType", "GeoY"}}},
        {"c", {{"_CoordinateAxisType", "Height"}}}}},
      {{{"a", {{"standard_name", "projection_x_coordinate"}}},
        {"b", {{"standard_name", "projection_y_coordinate"}}},
        {"c", {{"standard_name", "altitude"}}}}},
      {{{"a", {{"units", "degreesE"}}}, {"b", {{"units", "degree_N"}}}, {"c", {{"positive", "up"}}}}},
      {{{"x", {}}, {"y", {}}, {"z", {}}}},
      {{{"Longitude", {}}, {"Latitude", {}}, {"unheard_of", {}}}},
      {{{"rlon", {}}, {"unheard_of", {}}, {"level", {}}}},
  };
  test::SomeCases some(4);
  for (const auto& c : cases) {
    SCOPED_TRACE(c[0].first);
    const std::array<AxisOfFile, 3> axes = {AxisOfFile{c[0].first, c[0].second, {0, 1, 2, 3, 4}},
                                            AxisOfFile{c[1].first, c[1].second, {0, 1, 2, 3}},
                                            AxisOfFile{c[2].first, c[2].second, {5, 6, 7}}};
    for (const std::array<std::size_t, 3>& order : {std::array<std::size_t, 3>{0, 1, 2}, {2, 0, 1}, {1, 2, 0}}) {
      if (!some.next()) continue;
      write_marked(file, axes, order);
      EXPECT_EQ(place_of_marker(open_volume(file)), glm::dvec3(3, 1, 5));
    }
  }
}

TEST(NetcdfAxes, WithoutAttributesTheLastIsX) {
  const test::TemporaryFolder folder;
  const std::array<AxisOfFile, 3> axes = {AxisOfFile{"p", {}, {0, 1, 2, 3, 4}}, AxisOfFile{"q", {}, {0, 1, 2, 3}},
                                          AxisOfFile{"r", {}, {5, 6, 7}}};
  write_marked(folder / "a.nc", axes, {2, 1, 0});
  EXPECT_EQ(place_of_marker(open_volume(folder / "a.nc")), glm::dvec3(3, 1, 5));
}

TEST(NetcdfAxes, VerticalAxesPointUp) {
  const test::TemporaryFolder folder;
  const auto file = folder / "v.nc";
  struct Vertical {
    const char* name;
    Texts attributes;
    bool down;
  };
  const std::vector<Vertical> verticals = {
      {"level", {{"units", "millibars"}}, true},
      {"plev", {{"units", "Pa"}, {"standard_name", "air_pressure"}}, true},
      {"isobaric", {{"units", "hPa"}, {"_CoordinateAxisType", "Pressure"}}, true},
      {"p", {{"units", "dbar"}, {"standard_name", "sea_water_pressure"}}, true},
      {"p", {{"units", "hPa"}, {"positive", "up"}}, false},
      {"lev", {{"standard_name", "atmosphere_sigma_coordinate"}}, true},
      {"lev", {{"standard_name", "atmosphere_hybrid_sigma_pressure_coordinate"}, {"units", "1"}}, true},
      {"lev", {{"standard_name", "atmosphere_ln_pressure_coordinate"}}, false},
      {"lev", {{"standard_name", "atmosphere_hybrid_height_coordinate"}}, false},
      {"lev", {{"units", "sigma_level"}}, true},
      {"s_rho", {{"standard_name", "ocean_s_coordinate_g1"}}, false},
      {"olevel", {{"standard_name", "depth"}, {"units", "m"}}, true},
      {"deptht", {{"units", "m"}}, true},
      {"depth", {{"units", "m"}, {"positive", "Down"}}, true},
      {"depth", {{"units", "m"}, {"positive", "up"}}, false},
      {"z", {{"units", "m"}, {"_CoordinateZisPositive", "down"}}, true},
      {"height", {{"units", "m"}}, false},
  };
  for (const Vertical& vertical : verticals) {
    SCOPED_TRACE(::testing::Message() << vertical.name << " "
                                      << (vertical.attributes.empty() ? "" : vertical.attributes[0].second));
    const AxisOfFile axis{vertical.name, vertical.attributes, {100, 500, 1000}};
    write_marked(file, {longitude, latitude, axis}, {2, 1, 0});
    EXPECT_EQ(place_of_marker(open_volume(file)), glm::dvec3(40, 0, vertical.down ? -100 : 100));
  }
}

TEST(NetcdfAxes, OutsideOfSpaceAreSteps) {
  const test::TemporaryFolder folder;
  for (const auto& [name, attribute] : std::vector<std::pair<const char*, const char*>>{
           {"member", "realization"}, {"month", ""}, {"number", ""}, {"spectral_band", ""}}) {
    SCOPED_TRACE(name);
    // At any position among the dimensions.
    for (const std::size_t where : {0u, 1u, 3u}) {
      {
        NetcdfWriter w(folder / "members.nc", NC_NETCDF4);
        std::vector<int> dimensions = {w.dimension("z", 2), w.dimension("y", 2), w.dimension("x", 2)};
        const int extra = w.dimension(name, 3);
        const int coordinate = w.variable(name, NC_INT, {extra});
        if (*attribute != 0) w.text(coordinate, "standard_name", attribute);
        dimensions.insert(dimensions.begin() + static_cast<std::ptrdiff_t>(where), extra);
        const int v = w.variable("v", NC_FLOAT, dimensions);
        w.end_definitions();
        w.put(coordinate, {1, 2, 3});
        std::vector<double> values;
        std::array<std::size_t, 4> counts = {2, 2, 2, 2}, at{};
        counts[where] = 3;
        for (at[0] = 0; at[0] < counts[0]; ++at[0])
          for (at[1] = 0; at[1] < counts[1]; ++at[1])
            for (at[2] = 0; at[2] < counts[2]; ++at[2])
              for (at[3] = 0; at[3] < counts[3]; ++at[3]) {
                double value = 0;  // 100 steps + 4 z + 2 y + x
                for (std::size_t d = 0; d < 4; ++d)
                  if (d != where) value = 2 * value + static_cast<double>(at[d]);
                values.push_back(value + 100 * static_cast<double>(at[where]));
              }
        w.put(v, values);
      }
      ReadOptions options;
      for (const std::size_t step : {0, 1, 2}) {
        options.time_step = step;
        const VolumeFile volume = open_volume(folder / "members.nc", options);
        std::vector<double> expected(8);
        std::iota(expected.begin(), expected.end(), 100.0 * static_cast<double>(step));
        EXPECT_EQ(test::all_samples(*volume.source), expected);
        EXPECT_TRUE(has_note(volume, std::string("time steps are counted along ") + name + " (3)"));
      }
      options.time_step = 3;
      test::expect_no_volume(folder / "members.nc", "there is no time step 3, the file has 3", options);
    }
  }
}

TEST(NetcdfAxes, OfMembersAndTimesAreStepsTogether) {
  const test::TemporaryFolder folder;
  {
    NetcdfWriter w(folder / "both.nc", 0);
    const std::vector<int> dimensions = {w.dimension("time", 2), w.dimension("member", 3), w.dimension("z", 2),
                                         w.dimension("y", 2), w.dimension("x", 2)};
    const int v = w.variable("v", NC_FLOAT, dimensions);
    w.end_definitions();
    std::vector<double> values(48);
    std::iota(values.begin(), values.end(), 0.0);
    w.put(v, values);
  }
  ReadOptions options;
  options.time_step = 4;
  const VolumeFile volume = open_volume(folder / "both.nc", options);
  EXPECT_EQ(volume.range, (scene::ValueRange{32, 39, 0}));
  EXPECT_TRUE(has_note(volume, "time (2) and member (3), the last the fastest"));
}

TEST(NetcdfAxes, LongitudesThatPassTheEndOfTheCircleGoOn) {
  const test::TemporaryFolder folder;
  AxisOfFile axis = longitude;
  axis.coordinates = {340, 350, 0, 10, 20};
  write_marked(folder / "a.nc", {axis, latitude, height}, {2, 1, 0});
  EXPECT_EQ(place_of_marker(open_volume(folder / "a.nc")), glm::dvec3(370, 0, 100));
}

/// A curvilinear grid of 4 x 3 x 2 samples, with the field's dimensions in a given order; values 100 k + 10 j + i.
struct Curved {
  std::array<std::size_t, 3> order = {2, 1, 0};  ///< of x, y, z
  bool cells = false;                            ///< with corners of cells
  std::size_t first_corner = 0;                  ///< in the file's list
  bool turned = false;                           ///< corners go around in the other direction
  bool down = false, level_bounds = false;
};

void write_curved(const std::filesystem::path& file, const Curved& of) {
  constexpr std::array<std::size_t, 3> sizes = {4, 3, 2};
  NetcdfWriter w(file, NC_NETCDF4);
  const std::array<int, 3> d = {w.dimension("i", 4), w.dimension("j", 3), w.dimension("deptht", 2)};
  const int n = w.dimension("nvertex", 4), two = w.dimension("two", 2);
  const int vlon = w.variable("nav_lon", NC_DOUBLE, {d[1], d[0]}),
            vlat = w.variable("nav_lat", NC_DOUBLE, {d[1], d[0]}),
            blon = of.cells ? w.variable("blon", NC_DOUBLE, {d[1], d[0], n}) : -1,
            blat = of.cells ? w.variable("blat", NC_DOUBLE, {d[1], d[0], n}) : -1,
            vz = w.variable("deptht", NC_DOUBLE, {d[2]}), bz = w.variable("bz", NC_DOUBLE, {d[2], two}),
            v = w.variable("v", NC_DOUBLE, {d[of.order[0]], d[of.order[1]], d[of.order[2]]});
  w.text(vlon, "units", "degrees_east"), w.text(vlat, "units", "degrees_north"), w.text(vz, "units", "m");
  w.text(vz, "positive", of.down ? "down" : "up");
  if (of.cells) w.text(vlon, "bounds", "blon"), w.text(vlat, "bounds", "blat");
  if (of.level_bounds) w.text(vz, "bounds", "bz");
  w.text(v, "coordinates", "nav_lat nav_lon");
  w.end_definitions();
  std::vector<double> lon, lat, lon_bounds, lat_bounds, values;
  const auto x_of = [](double i, double j) { return 2 * i + 0.5 * j; };
  for (int j = 0; j < 3; ++j)
    for (int i = 0; i < 4; ++i) {
      lon.push_back(x_of(i, j)), lat.push_back(3 * j);
      constexpr std::array<double, 4> right = {-0.5, 0.5, 0.5, -0.5}, up = {-0.5, -0.5, 0.5, 0.5};
      for (std::size_t k = 0; k < 4; ++k) {
        const std::size_t corner = (of.first_corner + (of.turned ? 4 - k : k)) % 4;
        lon_bounds.push_back(x_of(i + right[corner], j + up[corner])), lat_bounds.push_back(3 * (j + up[corner]));
      }
    }
  std::array<std::size_t, 3> at{};
  for (at[of.order[0]] = 0; at[of.order[0]] < sizes[of.order[0]]; ++at[of.order[0]])
    for (at[of.order[1]] = 0; at[of.order[1]] < sizes[of.order[1]]; ++at[of.order[1]])
      for (at[of.order[2]] = 0; at[of.order[2]] < sizes[of.order[2]]; ++at[of.order[2]])
        values.push_back(static_cast<double>(100 * at[2] + 10 * at[1] + at[0]));
  w.put(vlon, lon), w.put(vlat, lat);
  if (of.cells) w.put(blon, lon_bounds), w.put(blat, lat_bounds);
  w.put(vz, {10, 20}), w.put(bz, {0, 16, 16, 30}), w.put(v, values);
}

TEST(NetcdfAxes, OfCurvilinearPointsComeInAnyOrder) {
  const test::TemporaryFolder folder;
  Curved of;
  std::sort(of.order.begin(), of.order.end());
  do
    for (const bool down : {false, true}) {
      of.down = down;
      write_curved(folder / "c.nc", of);
      const cells::MeshFile mesh = read_mesh(folder / "c.nc");
      EXPECT_EQ(mesh.counts.cells_read, 6u);
      EXPECT_NEAR(testing::volume(mesh.mesh), 6 * 6 * 10, 1e-9);
      for (std::size_t p = 0; p < mesh.mesh.positions.size(); ++p) {
        const glm::dvec3& at = mesh.mesh.positions[p];
        const double j = at.y / 3, i = (at.x - 0.5 * j) / 2, k = std::abs(at.z) / 10 - 1;
        EXPECT_EQ(at.z < 0, down);
        EXPECT_NEAR(mesh.mesh.scalars[p], 100 * k + 10 * j + i, 1e-9);
      }
    }
  while (std::next_permutation(of.order.begin(), of.order.end()));
}

TEST(NetcdfAxes, OfCurvilinearCellsHaveCornersFromAnyOn) {
  const test::TemporaryFolder folder;
  for (std::size_t variant = 0; variant < 16; ++variant) {
    Curved of;
    of.cells = true, of.first_corner = variant % 4, of.turned = variant % 8 >= 4;
    of.down = variant >= 4, of.level_bounds = variant >= 8;
    SCOPED_TRACE(variant);
    write_curved(folder / "c.nc", of);
    const cells::MeshFile mesh = read_mesh(folder / "c.nc");
    EXPECT_EQ(mesh.counts.cells_read, 24u);
    EXPECT_NEAR(testing::volume(mesh.mesh), 12 * 6 * (of.level_bounds ? 30 : 20), 1e-9);
    for (std::size_t t = 0; t < mesh.mesh.tets.size(); ++t) {
      glm::dvec3 middle(0);
      for (const std::uint32_t p : mesh.mesh.tets[t]) middle += mesh.mesh.positions[p] / 4.0;
      const double j = std::floor(middle.y / 3 + 0.5), i = std::floor((middle.x - middle.y / 6) / 2 + 0.5);
      const double z = of.down ? -middle.z : middle.z, k = z < (of.level_bounds ? 16 : 15) ? 0 : 1;
      EXPECT_EQ(mesh.mesh.scalars[t], 100 * k + 10 * j + i);
    }
  }
}

}  // namespace
}  // namespace tessera::io::netcdf_axes_test
