// SPDX-License-Identifier: BSD-3-Clause
// NetCDF grids and MINC 1 volumes, written by NetCDF's library.
#include <gtest/gtest.h>
#include <zlib.h>

#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "io/volume/volume_formats.hpp"
#include "readers/netcdf_writer.hpp"
#include "support/changed_bytes.hpp"
#include "support/mesh_checks.hpp"
#include "support/read_files.hpp"
#include "support/temporary_folder.hpp"
#include "support/volume_checks.hpp"

namespace tessera::io::netcdf_test {
namespace {

using scene::GridIndex;
using test::all_samples;
using test::expect_no_volume;
using test::has_note;
using test::NetcdfWriter;

/// `count` numbers from `first` on.
std::vector<double> ramp(std::size_t count, double first) {
  std::vector<double> values(count);
  for (std::size_t k = 0; k < count; ++k) values[k] = first + static_cast<double>(k);
  return values;
}

glm::dvec3 at(const scene::GridGeometry& g, const GridIndex& index) {
  return scene::world_of_index(g, {index[0], index[1], index[2]});
}

/// Air with 5 x 4 x 3 samples at two times. Levels decrease and are not uniform; latitudes decrease. T is a float with
/// a fill value, P is packed in shorts with a fill value, and W is on other levels.
void write_air(const std::filesystem::path& file, int mode) {
  NetcdfWriter w(file, mode);
  const int time = w.dimension("time", NC_UNLIMITED), lev = w.dimension("lev", 3), ilev = w.dimension("ilev", 2),
            lat = w.dimension("lat", 4), lon = w.dimension("lon", 5);
  const int vtime = w.variable("time", NC_DOUBLE, {time}), vlev = w.variable("lev", NC_DOUBLE, {lev}),
            vlat = w.variable("lat", NC_FLOAT, {lat}), vlon = w.variable("lon", NC_FLOAT, {lon});
  w.text(vtime, "units", "days since 2000-01-01");
  w.text(vlev, "units", "m");
  w.text(vlat, "units", "degrees_north");
  w.text(vlon, "units", "degrees_east");
  const int t = w.variable("T", NC_FLOAT, {time, lev, lat, lon}), p = w.variable("P", NC_SHORT, {time, lev, lat, lon}),
            u = w.variable("W", NC_DOUBLE, {time, ilev, lat, lon});
  w.number(t, "_FillValue", NC_FLOAT, {-999});
  w.number(t, "missing_value", NC_FLOAT, {-888});
  w.number(p, "_FillValue", NC_SHORT, {-7});
  w.number(p, "scale_factor", NC_DOUBLE, {0.1});
  w.number(p, "add_offset", NC_DOUBLE, {100});
  w.end_definitions();
  w.put(vlev, {1000, 500, 100});
  w.put(vlat, {60, 30, 0, -30});
  w.put(vlon, {0, 10, 20, 30, 40});
  for (std::size_t step = 0; step < 2; ++step) {
    w.put(vtime, {step}, {1}, {5.0 * static_cast<double>(step)});
    std::vector<double> values = ramp(60, 100 * static_cast<double>(step));
    w.put(u, {step, 0, 0, 0}, {1, 2, 4, 5}, ramp(40, 7));
    values[8] = -7;
    w.put(p, {step, 0, 0, 0}, {1, 3, 4, 5}, values);
    values[8] = -888, values[9] = -999;
    w.put(t, {step, 0, 0, 0}, {1, 3, 4, 5}, values);
  }
}

TEST(NetcdfGrids, HaveTheirValuesAtTheirPositions) {
  const test::TemporaryFolder folder;
  for (const int mode : {0, NC_64BIT_OFFSET, NC_NETCDF4}) {
    SCOPED_TRACE(mode);
    write_air(folder / "air", mode);  // its name does not matter
    ASSERT_TRUE(is_volume(folder / "air"));
    ReadOptions options;
    options.field = "T";
    const VolumeFile volume = open_volume(folder / "air", options);
    EXPECT_EQ(volume.format, "NetCDF");
    const scene::GridGeometry& g = volume.source->geometry();
    EXPECT_EQ(g.points, (GridIndex{5, 4, 3}));
    ASSERT_TRUE(g.rectilinear());  // by its levels
    // Decreasing axes are reversed: the first sample is at its position in the file.
    EXPECT_EQ(at(g, {0, 0, 0}), glm::dvec3(0, 60, 1000));
    EXPECT_EQ(at(g, {4, 1, 1}), glm::dvec3(40, 30, 500));
    EXPECT_EQ(at(g, {4, 3, 2}), glm::dvec3(40, -30, 100));
    const std::vector<double> samples = all_samples(*volume.source);
    EXPECT_EQ(samples[0], 100);  // value at the last time step
    EXPECT_EQ(samples[59], 159);
    EXPECT_TRUE(std::isnan(samples[8]) && std::isnan(samples[9]));
    EXPECT_EQ(volume.range, (scene::ValueRange{100, 159, 2}));
    EXPECT_EQ(volume.time_step.step, 1u);
    EXPECT_EQ(volume.time_step.times, (std::vector<double>{0, 5}));
    EXPECT_TRUE(has_note(volume, "(ilev, lat, lon), has W"));
    EXPECT_TRUE(has_note(volume, "longitude and latitude"));
    options.time_step = 0;
    EXPECT_EQ(open_volume(folder / "air", options).range, (scene::ValueRange{0, 59, 2}));
    options.time_step = 2;
    expect_no_volume(folder / "air", "there is no time step 2", options);
  }
}

TEST(NetcdfGrids, MayBeHdf5BehindAUserBlock) {
  const test::TemporaryFolder folder;
  write_air(folder / "a.nc", NC_NETCDF4);
  ReadOptions options;
  options.field = "P";
  const std::vector<double> whole = all_samples(*open_volume(folder / "a.nc", options).source);
  for (const std::size_t block : {512u, 2048u}) {
    folder.write("b.nc", std::string(block, 'u') + test::contents(folder / "a.nc"));
    const VolumeFile volume = open_volume(folder / "b.nc", options);
    EXPECT_EQ(volume.format, "NetCDF");
    const std::vector<double> samples = all_samples(*volume.source);
    ASSERT_EQ(samples.size(), whole.size());
    for (std::size_t k = 0; k < whole.size(); ++k)
      EXPECT_TRUE(samples[k] == whole[k] || (std::isnan(samples[k]) && std::isnan(whole[k])));
  }
}

TEST(NetcdfGrids, ArePackedOrOfOtherDimensionsByTheirField) {
  const test::TemporaryFolder folder;
  write_air(folder / "air.nc", 0);
  ReadOptions options;
  options.field = "P";
  const std::vector<double> packed = all_samples(*open_volume(folder / "air.nc", options).source);
  EXPECT_TRUE(std::isnan(packed[8]));
  EXPECT_EQ(packed[9], 109 * 0.1 + 100);
  EXPECT_EQ(packed[7], 107 * 0.1 + 100);
  options.field = "W";
  const VolumeFile other = open_volume(folder / "air.nc", options);
  EXPECT_EQ(other.source->geometry().points, (GridIndex{5, 4, 2}));
  EXPECT_EQ(other.range, (scene::ValueRange{7, 46, 0}));
  options.field = "V";
  expect_no_volume(folder / "air.nc", "'V'", options);
}

TEST(NetcdfGrids, WithoutCoordinatesHaveUnitSteps) {
  const test::TemporaryFolder folder;
  {
    NetcdfWriter w(folder / "plain.nc", 0);
    const std::vector<int> dimensions = {w.dimension("a", 2), w.dimension("b", 3), w.dimension("c", 4)};
    const int v = w.variable("v", NC_BYTE, dimensions);
    w.number(v, "_FillValue", NC_BYTE, {-1});
    w.end_definitions();
    std::vector<double> values = ramp(24, 0);
    values[0] = -128, values[23] = -1;
    w.put(v, values);
  }
  const VolumeFile volume = open_volume(folder / "plain.nc");
  EXPECT_FALSE(volume.source->geometry().rectilinear());
  EXPECT_EQ(at(volume.source->geometry(), {3, 2, 1}), glm::dvec3(3, 2, 1));
  EXPECT_EQ(volume.range, (scene::ValueRange{-128, 22, 1}));
}

TEST(NetcdfGrids, InAGzipFileAreReadOrToBeUnpacked) {
  const test::TemporaryFolder folder;
  const auto packed = [&](int mode) {
    write_air(folder / "air.nc", mode);
    const std::string whole = test::contents(folder / "air.nc");
    gzFile out = gzopen((folder / "air.nc.gz").c_str(), "wb");
    EXPECT_EQ(gzwrite(out, whole.data(), static_cast<unsigned>(whole.size())), static_cast<int>(whole.size()));
    gzclose(out);
    return folder / "air.nc.gz";
  };
  ASSERT_TRUE(is_volume(packed(0)));
  ReadOptions options;
  options.field = "T";
  EXPECT_EQ(open_volume(folder / "air.nc.gz", options).range, (scene::ValueRange{100, 159, 2}));
  const auto hdf5 = packed(NC_NETCDF4);
  EXPECT_FALSE(is_volume(hdf5));
  test::expect_bad_input([&] { read_mesh(hdf5); }, {"air.nc.gz: ", "unpack it with gunzip"});
}

TEST(NetcdfGrids, KnowTimeByItsNameToo) {
  const test::TemporaryFolder folder;
  {
    NetcdfWriter w(folder / "wrf", 0);
    const std::vector<int> dimensions = {w.dimension("Time", NC_UNLIMITED), w.dimension("bottom_top", 2),
                                         w.dimension("south_north", 2), w.dimension("west_east", 2)};
    const int v = w.variable("T", NC_FLOAT, dimensions);
    w.end_definitions();
    w.put(v, {0, 0, 0, 0}, {3, 2, 2, 2}, ramp(24, 0));
  }
  ReadOptions options;
  for (const std::size_t step : {0, 1, 2}) {
    options.time_step = step;
    const double first = 8 * static_cast<double>(step);
    EXPECT_EQ(open_volume(folder / "wrf", options).range, (scene::ValueRange{first, first + 7, 0}));
  }
}

TEST(NetcdfGrids, OfOneTimeHaveIt) {
  const test::TemporaryFolder folder;
  for (const std::size_t members : {1, 2}) {
    {
      NetcdfWriter w(folder / "one", 0);
      const int time = w.dimension("time", 1), member = w.dimension("member", members);
      const std::vector<int> dimensions = {time, member, w.dimension("z", 2), w.dimension("y", 2), w.dimension("x", 2)};
      const int vtime = w.variable("time", NC_DOUBLE, {time}), v = w.variable("T", NC_FLOAT, dimensions);
      w.end_definitions();
      w.put(vtime, {6.5});
      w.put(v, ramp(8 * members, 0));
    }
    const scene::TimeStepRead read = open_volume(folder / "one").time_step;
    EXPECT_EQ(read.count, members);
    EXPECT_EQ(read.times, members == 1 ? std::vector{6.5} : std::vector<double>());  // members are steps too
  }
}

TEST(NetcdfGrids, OfTwoDimensionalCoordinatesAreMeshes) {
  const test::TemporaryFolder folder;
  {
    NetcdfWriter w(folder / "ocean.nc", NC_NETCDF4);
    const int z = w.dimension("z", 2), y = w.dimension("y", 3), x = w.dimension("x", 3);
    const int vz = w.variable("z", NC_DOUBLE, {z}), vlat = w.variable("tlat", NC_DOUBLE, {y, x}),
              vlon = w.variable("tlon", NC_DOUBLE, {y, x}), v = w.variable("v", NC_DOUBLE, {z, y, x});
    w.text(vz, "units", "m");
    w.text(vlat, "units", "degrees_north");
    w.text(vlon, "units", "degrees_east");
    w.text(v, "coordinates", "tlon tlat");
    w.end_definitions();
    std::vector<double> lon, lat, values;
    for (int k = 0; k < 2; ++k)
      for (int j = 0; j < 3; ++j)
        for (int i = 0; i < 3; ++i) {
          const double a = 2 * i + j, b = 3 * j;  // a sheared grid of 6 x 6
          if (k == 0) lon.push_back(a), lat.push_back(b);
          values.push_back(a + 10 * b + 100 * k);
        }
    w.put(vz, {0, 5});
    w.put(vlat, lat);
    w.put(vlon, lon);
    w.put(v, values);
  }
  EXPECT_FALSE(is_volume(folder / "ocean.nc"));
  const cells::MeshFile mesh = read_mesh(folder / "ocean.nc");
  EXPECT_EQ(mesh.format, "NetCDF");
  EXPECT_EQ(mesh.counts.cells_read, 4u);
  EXPECT_NEAR(testing::volume(mesh.mesh), 4 * 6 * 5, 1e-12);
  for (std::size_t p = 0; p < mesh.mesh.positions.size(); ++p) {
    const glm::dvec3& at = mesh.mesh.positions[p];
    EXPECT_EQ(mesh.mesh.scalars[p], at.x + 10 * at.y + 20 * at.z);
  }
}

TEST(NetcdfGrids, CellsWithBoundsHaveAValueEach) {
  const test::TemporaryFolder folder;
  {
    NetcdfWriter w(folder / "cells.nc", NC_NETCDF4);
    const int z = w.dimension("z", 2), y = w.dimension("y", 2), x = w.dimension("x", 2), n = w.dimension("n", 4);
    const int vz = w.variable("z", NC_DOUBLE, {z}), vlat = w.variable("clat", NC_DOUBLE, {y, x}),
              vlon = w.variable("clon", NC_DOUBLE, {y, x}), blat = w.variable("blat", NC_DOUBLE, {y, x, n}),
              blon = w.variable("blon", NC_DOUBLE, {y, x, n}), v = w.variable("v", NC_DOUBLE, {z, y, x});
    w.text(vz, "units", "m");
    w.text(vlat, "units", "degrees_north");
    w.text(vlon, "units", "degrees_east");
    w.text(vlat, "bounds", "blat");
    w.text(vlon, "bounds", "blon");
    w.text(v, "coordinates", "clon clat");
    w.end_definitions();
    std::vector<double> lon, lat, lon_bounds, lat_bounds;
    for (int j = 0; j < 2; ++j)
      for (int i = 0; i < 2; ++i) {
        lon.push_back(i + 0.5), lat.push_back(j + 0.5);
        for (const double dx : {0, 1, 1, 0}) lon_bounds.push_back(i + dx);
        for (const double dy : {0, 0, 1, 1}) lat_bounds.push_back(j + dy);
      }
    w.put(vz, {1, 3});  // levels halfway between 0, 2 and 4
    w.put(vlat, lat);
    w.put(vlon, lon);
    w.put(blat, lat_bounds);
    w.put(blon, lon_bounds);
    w.put(v, ramp(8, 0));
  }
  const cells::MeshFile mesh = read_mesh(folder / "cells.nc");
  EXPECT_EQ(mesh.counts.cells_read, 8u);
  EXPECT_NEAR(testing::volume(mesh.mesh), 2 * 2 * 4, 1e-12);
  for (std::size_t t = 0; t < mesh.mesh.tets.size(); ++t) {
    glm::dvec3 middle(0);
    for (const std::uint32_t p : mesh.mesh.tets[t]) middle += mesh.mesh.positions[p] / 4.0;
    EXPECT_EQ(mesh.mesh.scalars[t], std::floor(middle.x) + 2 * std::floor(middle.y) + 4 * std::floor(middle.z / 2));
  }
}

TEST(NetcdfGrids, RefusesDamagedFilesInOneLine) {
  const test::TemporaryFolder folder;
  for (const int mode : {0, NC_NETCDF4}) {
    write_air(folder / "air.nc", mode);
    const std::string whole = test::contents(folder / "air.nc");
    for (const std::size_t size : {whole.size() - 600, whole.size() / 2, std::size_t{30}}) {
      const auto cut = folder.write("cut.nc", whole.substr(0, size));
      test::expect_bad_input([&] { read_mesh(cut); }, {"cut.nc: ", "; "});
      EXPECT_FALSE(is_volume(cut));
    }
  }
  for (const int mode : {0, NC_NETCDF4})
    for (const bool has_time : {false, true}) {  // time does not count as the third spatial dimension
      {
        NetcdfWriter w(folder / "flat.nc", mode);
        std::vector<int> dimensions;
        if (has_time) dimensions.push_back(w.dimension("time", 2));
        for (const int d : {w.dimension("y", 3), w.dimension("x", 4)}) dimensions.push_back(d);
        w.variable("v", NC_DOUBLE, dimensions);
        w.end_definitions();
      }
      test::expect_bad_input([&] { read_mesh(folder / "flat.nc"); },
                             {"flat.nc: none of its variables has three dimens"});
      EXPECT_FALSE(is_volume(folder / "flat.nc"));
    }
}

/// Reads the file as a grid or as a mesh.
void read_any(const std::filesystem::path& file) {
  if (is_volume(file))
    open_volume(file);
  else
    read_mesh(file);
}

TEST(NetcdfGrids, ChangedBytesNeverCrash) {
  const test::TemporaryFolder folder;
  for (const int mode : {0, NC_NETCDF4}) {
    write_air(folder / "air", mode);
    test::expect_no_crash_of_changes(folder, "changed.nc", test::contents(folder / "air"), read_any);
  }
}

/// A MINC volume of 2 x 3 x 4 samples (z, y, x) in signed shorts, each slice with its own range.
void write_minc(const std::filesystem::path& file, bool has_time) {
  NetcdfWriter w(file, 0);
  std::vector<int> dimensions;
  if (has_time) dimensions.push_back(w.dimension("time", 2));
  const int z = w.dimension("zspace", 2), y = w.dimension("yspace", 3), x = w.dimension("xspace", 4);
  for (const int d : {z, y, x}) dimensions.push_back(d);
  const auto axis = [&](const char* name, double start, double step, const std::vector<double>& cosines) {
    const int v = w.variable(name, NC_INT, {});
    w.text(v, "varid", "MINC standard variable");
    w.text(v, "vartype", "dimension____");
    w.text(v, "spacing", "regular__");
    w.number(v, "start", NC_DOUBLE, {start});
    w.number(v, "step", NC_DOUBLE, {step});
    if (!cosines.empty()) w.number(v, "direction_cosines", NC_DOUBLE, cosines);
  };
  if (has_time) axis("time", 3, 1.5, {});
  axis("xspace", 10, 0.5, {0, 1, 0});
  axis("yspace", 20, -2, {-1, 0, 0});  // decreases
  axis("zspace", 30, 3, {0, 0, 1});
  const int image = w.variable("image", NC_SHORT, dimensions);
  w.text(image, "varid", "MINC standard variable");
  w.text(image, "signtype", "signed__");
  w.number(image, "valid_range", NC_DOUBLE, {0, 1000});
  const std::vector<int> of_slices(dimensions.begin(), dimensions.end() - 2);
  const int high = w.variable("image-max", NC_DOUBLE, of_slices), low = w.variable("image-min", NC_DOUBLE, of_slices);
  w.end_definitions();
  const std::size_t steps = has_time ? 2 : 1;
  w.put(image, ramp(24 * steps, 0));
  w.put(low, has_time ? std::vector<double>{0, 0, 0, 0} : std::vector<double>{0, 5});
  w.put(high, has_time ? std::vector<double>{1000, 1000, 1000, 1000} : std::vector<double>{1000, 505});
}

TEST(Minc, RealValuesArePlacedByTheDirectionCosines) {
  const test::TemporaryFolder folder;
  write_minc(folder / "head.mnc", false);
  ASSERT_TRUE(is_volume(folder / "head.mnc"));
  const VolumeFile volume = open_volume(folder / "head.mnc");
  EXPECT_EQ(volume.format, "MINC 1");
  const scene::GridGeometry& g = volume.source->geometry();
  EXPECT_EQ(g.points, (GridIndex{4, 3, 2}));
  const std::vector<double> samples = all_samples(*volume.source);
  const auto value_at = [&](const GridIndex& index) {
    return samples[static_cast<std::size_t>(index[0] + 4 * (index[1] + 3 * index[2]))];
  };
  // A sample of the file, and its position: start + step * index along each axis' direction.
  const auto expect = [&](std::int64_t i, std::int64_t j, std::int64_t k) {
    const glm::dvec3 place = (10 + 0.5 * double(i)) * glm::dvec3(0, 1, 0) +
                             (20 - 2 * double(j)) * glm::dvec3(-1, 0, 0) + (30 + 3 * double(k)) * glm::dvec3(0, 0, 1);
    const double raw = double(i + 4 * (j + 3 * k)), real = k == 0 ? raw : 5 + raw / 2;
    for (const std::int64_t row : {j, 2 - j}) {  // the reader may reverse rows
      if (glm::length(at(g, {i, row, k}) - place) < 1e-12) {
        EXPECT_EQ(value_at({i, row, k}), real);
        return;
      }
    }
    ADD_FAILURE() << "no sample lies at " << place.x << " " << place.y << " " << place.z;
  };
  expect(0, 0, 0);
  expect(3, 0, 1);
  expect(1, 2, 1);
}

/// A volume of 24 samples from `first` on, with real values from 0 to 230 over the valid range.
VolumeFile minc_of(const std::filesystem::path& file, nc_type type, const char* sign, nc_type of_range,
                   const std::vector<double>& range, double first) {
  {
    NetcdfWriter w(file, 0);
    std::vector<int> dimensions;
    for (const auto& [name, length] : {std::pair("zspace", 2), std::pair("yspace", 3), std::pair("xspace", 4)})
      dimensions.push_back(w.dimension(name, static_cast<std::size_t>(length)));
    for (const auto& [name, cosines] :
         {std::pair("xspace", std::vector<double>{0, 1, 0}), std::pair("yspace", std::vector<double>{1, 0, 0}),
          std::pair("zspace", std::vector<double>{0, 0, 1})}) {
      const int axis = w.variable(name, NC_INT, {});
      w.number(axis, "start", NC_DOUBLE, {0});
      w.number(axis, "step", NC_DOUBLE, {1});
      w.number(axis, "direction_cosines", NC_FLOAT, cosines);
    }
    const int image = w.variable("image", type, dimensions);
    w.text(image, "signtype", sign);
    if (!range.empty()) w.number(image, "valid_range", of_range, range);
    const int high = w.variable("image-max", NC_DOUBLE, {}), low = w.variable("image-min", NC_DOUBLE, {});
    w.end_definitions();
    w.put(image, ramp(24, first));
    w.put(low, std::vector<double>{0});
    w.put(high, std::vector<double>{230});
  }
  return open_volume(file);
}

TEST(Minc, TheValidRangeMayBeOfAnyType) {
  const test::TemporaryFolder folder;
  const auto check = [&](nc_type type, const char* sign, nc_type of_range, const std::vector<double>& range,
                         double first, double slope, double intercept) {
    const VolumeFile volume = minc_of(folder / "v.mnc", type, sign, of_range, range, first);
    const std::vector<double> samples = all_samples(*volume.source);
    for (std::size_t k = 0; k < 24; ++k)
      EXPECT_NEAR(samples[k], (first + double(k)) * slope + intercept, 1e-4) << type << " " << of_range;
    // Along y, by cosines that are not doubles.
    EXPECT_EQ(at(volume.source->geometry(), {1, 0, 0}) - at(volume.source->geometry(), {0, 0, 0}), glm::dvec3(0, 1, 0));
  };
  for (const nc_type of_range : {NC_SHORT, NC_INT, NC_FLOAT, NC_DOUBLE})
    check(NC_SHORT, "signed__", of_range, {0, 23}, 0, 10, 0);
  check(NC_SHORT, "signed__", NC_SHORT, {23, 0}, 0, 10, 0);
  check(NC_SHORT, "signed__", NC_SHORT, {-23, 23}, 0, 5, 115);
  check(NC_BYTE, "unsigned", NC_BYTE, {0, 23}, 0, 10, 0);
  check(NC_BYTE, "unsigned", NC_BYTE, {0, -26}, 0, 1, 0);  // 230
  check(NC_BYTE, "unsigned", NC_DOUBLE, {0, 230}, 0, 1, 0);
  check(NC_BYTE, "signed__", NC_BYTE, {-115, 115}, -23, 1, 115);
  check(NC_BYTE, "signed__", NC_BYTE, {}, -23, 230.0 / 255, 230.0 * 128 / 255);
  check(NC_SHORT, "unsigned", NC_SHORT, {0, -1}, 0, 230.0 / 65535, 0);
  check(NC_BYTE, "unsigned", NC_BYTE, {}, 0, 230.0 / 255, 0);
  check(NC_SHORT, "signed__", NC_BYTE, {}, 0, 230.0 / 65535, 230.0 * 32768 / 65535);
  // Floats are real values.
  check(NC_FLOAT, "signed__", NC_FLOAT, {0, 23}, 0, 1, 0);
  check(NC_DOUBLE, "signed__", NC_DOUBLE, {0, 23}, 0, 1, 0);
  test::expect_bad_input(
      [&] {
        minc_of(folder / "v.mnc", NC_SHORT, "signed__", NC_SHORT, {7, 7}, 0);
      },
      {"v.mnc: its valid_range is 7 to 7; "});
}

TEST(Minc, TimeStepsAreChosen) {
  const test::TemporaryFolder folder;
  write_minc(folder / "f.mnc", true);
  const VolumeFile last = open_volume(folder / "f.mnc");
  EXPECT_EQ(last.range, (scene::ValueRange{24, 47, 0}));
  EXPECT_EQ(last.time_step.times, (std::vector<double>{3, 4.5}));
  ReadOptions options;
  options.time_step = 0;
  EXPECT_EQ(open_volume(folder / "f.mnc", options).range, (scene::ValueRange{0, 23, 0}));
  options.time_step = 2;
  expect_no_volume(folder / "f.mnc", "there is no time step 2", options);
}

TEST(Minc, RefusesDamagedFilesInOneLine) {
  const test::TemporaryFolder folder;
  write_minc(folder / "head.mnc", false);
  const std::string whole = test::contents(folder / "head.mnc");
  for (const std::size_t size : {whole.size() - 60, whole.size() / 2})
    expect_no_volume(folder.write("cut.mnc", whole.substr(0, size)), "cut.mnc: ");
  test::expect_no_crash_of_changes(folder, "changed.mnc", whole, read_any);
}

}  // namespace
}  // namespace tessera::io::netcdf_test
