// SPDX-License-Identifier: BSD-3-Clause
// Values of NetCDF variables: every type, packing, and blanks defined by the conventions.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "readers/netcdf_writer.hpp"
#include "support/read_files.hpp"
#include "support/temporary_folder.hpp"
#include "support/volume_checks.hpp"

namespace tessera::io::netcdf_values_test {
namespace {

using test::has_note;
using test::NetcdfWriter;

const double nan = std::numeric_limits<double>::quiet_NaN();

struct Attribute {
  const char* name;
  nc_type type;
  std::vector<double> values;
};

/// A variable of 2 x 2 x 2 samples, read back; `written` may be shorter, the others are never written.
VolumeFile read_back(nc_type type, const std::vector<double>& written, const std::vector<Attribute>& attributes,
                     const char* is_unsigned = nullptr, int mode = NC_NETCDF4) {
  const test::TemporaryFolder folder;
  {
    NetcdfWriter w(folder / "v.nc", mode);
    const std::vector<int> dimensions = {w.dimension("z", 2), w.dimension("y", 2), w.dimension("x", 2)};
    const int v = w.variable("v", type, dimensions);
    for (const Attribute& attribute : attributes) w.number(v, attribute.name, attribute.type, attribute.values);
    if (is_unsigned != nullptr) w.text(v, "_Unsigned", is_unsigned);
    w.end_definitions();
    for (std::size_t k = 0; k < written.size(); ++k) w.put(v, {k / 4, k / 2 % 2, k % 2}, {1, 1, 1}, {written[k]});
  }
  return open_volume(folder / "v.nc");
}

void expect_samples(const VolumeFile& volume, const std::vector<double>& expected) {
  const std::vector<double> samples = test::all_samples(*volume.source);
  ASSERT_EQ(samples.size(), expected.size());
  for (std::size_t k = 0; k < samples.size(); ++k) {
    EXPECT_EQ(std::isnan(samples[k]), std::isnan(expected[k])) << k << ": " << samples[k];
    if (!std::isnan(expected[k])) {
      EXPECT_EQ(samples[k], expected[k]) << k;
    }
  }
}

TEST(NetcdfValues, OfEveryTypeAreReadAsTheyAre) {
  struct Case {
    nc_type type;
    double least, most;
    scene::SampleType as;
  };
  for (const Case& c :
       {Case{NC_BYTE, -128, 127, scene::SampleType::int8}, Case{NC_UBYTE, 0, 255, scene::SampleType::uint8},
        Case{NC_SHORT, -32768, 32767, scene::SampleType::int16}, Case{NC_USHORT, 0, 65534, scene::SampleType::uint16},
        Case{NC_INT, -2147483648.0, 2147483647, scene::SampleType::int32},
        Case{NC_UINT, 0, 4294967294, scene::SampleType::uint32},
        Case{NC_INT64, -0x1p62, 0x1p62, scene::SampleType::float64},
        Case{NC_UINT64, 0, 0x1p63, scene::SampleType::float64}, Case{NC_FLOAT, -1e30f, 0.5, scene::SampleType::float32},
        Case{NC_DOUBLE, -1e300, 1e300, scene::SampleType::float64}}) {
    SCOPED_TRACE(c.type);
    const std::vector<double> values = {c.least, 1, 2, 3, 4, 5, 6, c.most};
    const VolumeFile volume = read_back(c.type, values, {});
    EXPECT_EQ(volume.source->grid().type, c.as);
    expect_samples(volume, values);
  }
}

TEST(NetcdfValues, OfSignedTypesAreUnsignedByAnAttribute) {
  const std::vector<double> stored = {-1, 1, 2, 3, 4, 5, 6, -128};
  expect_samples(read_back(NC_BYTE, stored, {}, "true", 0), {255, 1, 2, 3, 4, 5, 6, 128});
  expect_samples(read_back(NC_BYTE, stored, {{"_FillValue", NC_BYTE, {-1}}}, "true", 0), {nan, 1, 2, 3, 4, 5, 6, 128});
  expect_samples(read_back(NC_SHORT, stored, {{"scale_factor", NC_FLOAT, {0.5}}}, "true", 0),
                 {32767.5, 0.5, 1, 1.5, 2, 2.5, 3, 32704});
  expect_samples(read_back(NC_BYTE, stored, {}, "false", 0), stored);
}

TEST(NetcdfValues, NeverWrittenAreBlankButForBytes) {
  for (const nc_type type : {NC_SHORT, NC_USHORT, NC_INT, NC_UINT, NC_INT64, NC_UINT64, NC_FLOAT, NC_DOUBLE}) {
    SCOPED_TRACE(type);
    const VolumeFile volume = read_back(type, {7, 1, 2, 3, 4, 5}, {});
    expect_samples(volume, {7, 1, 2, 3, 4, 5, nan, nan});
    EXPECT_EQ(volume.range, (scene::ValueRange{1, 7, 2}));
    EXPECT_TRUE(has_note(volume, "v: 2 samples of NetCDF's default fill value are blank"));
  }
  expect_samples(read_back(NC_BYTE, {7, 1, 2, 3, 4, 5, 6}, {}), {7, 1, 2, 3, 4, 5, 6, NC_FILL_BYTE});
  // An attribute replaces the default value.
  expect_samples(read_back(NC_SHORT, {7, 1, 2, 3, 4, 5, NC_FILL_SHORT, 8}, {{"_FillValue", NC_SHORT, {3}}}),
                 {7, 1, 2, nan, 4, 5, NC_FILL_SHORT, 8});
}

TEST(NetcdfValues, OutsideTheirValidRangeAreBlank) {
  const std::vector<double> stored = {-5, 0, 1, 2, 3, 4, 5, 90};
  const std::vector<double> within = {nan, 0, 1, 2, 3, 4, 5, nan};
  for (const nc_type type : {NC_BYTE, NC_SHORT, NC_INT64, NC_FLOAT, NC_DOUBLE}) {
    SCOPED_TRACE(type);
    const VolumeFile volume = read_back(type, stored, {{"valid_range", type, {0, 5}}});
    expect_samples(volume, within);
    EXPECT_TRUE(has_note(volume, "v: 2 samples outside its valid range are blank"));
    expect_samples(read_back(type, stored, {{"valid_min", type, {0}}, {"valid_max", type, {5}}}), within);
    expect_samples(read_back(type, stored, {{"valid_max", type, {5}}}), {-5, 0, 1, 2, 3, 4, 5, nan});
    expect_samples(read_back(type, stored, {{"valid_min", type, {0}}}), {nan, 0, 1, 2, 3, 4, 5, 90});
  }
  // For packed numbers, the valid range applies to the stored numbers, unless it has the type of the unpacked numbers.
  const std::vector<double> unpacked = {nan, 10, 12, 14, 16, 18, 20, nan};
  const Attribute scale{"scale_factor", NC_DOUBLE, {2}}, shift{"add_offset", NC_DOUBLE, {10}};
  expect_samples(read_back(NC_SHORT, stored, {scale, shift, {"valid_range", NC_SHORT, {0, 5}}}), unpacked);
  expect_samples(read_back(NC_SHORT, stored, {scale, shift, {"valid_range", NC_DOUBLE, {9, 21}}}), unpacked);
}

TEST(NetcdfValues, MissingValuesAreBlankAndOthersKeepTheirType) {
  const std::vector<double> stored = {-9999, 1, 2, 3, 4, 5, -888, 7};
  for (const nc_type type : {NC_SHORT, NC_INT, NC_INT64, NC_FLOAT, NC_DOUBLE}) {
    SCOPED_TRACE(type);
    expect_samples(read_back(type, stored, {{"_FillValue", type, {-9999}}, {"missing_value", type, {-888, -777}}}),
                   {nan, 1, 2, 3, 4, 5, nan, 7});
  }
  const VolumeFile without = read_back(NC_SHORT, {0, 1, 2, 3, 4, 5, 6, 7}, {{"_FillValue", NC_SHORT, {-9999}}});
  EXPECT_EQ(without.source->grid().type, scene::SampleType::int16);
}

TEST(NetcdfValues, OfGroupsAreNamedByTheirPaths) {
  const test::TemporaryFolder folder;
  {
    NetcdfWriter root(folder / "g.nc", NC_NETCDF4);
    const int x = root.dimension("x", 2), vx = root.variable("x", NC_DOUBLE, {x});
    root.string(vx, "units", "degrees_east");
    root.end_definitions();
    root.put(vx, {10, 20});
    NetcdfWriter group(root, "ocean");
    NetcdfWriter inner(group, "upper");
    // The x axis is the root's, at any position among the dimensions.
    const int v = inner.variable("t", NC_UBYTE, {x, inner.dimension("z", 3), inner.dimension("y", 2)});
    inner.end_definitions();
    inner.put(v, {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11});
  }
  ReadOptions options;
  options.field = "ocean/upper/t";
  const VolumeFile volume = open_volume(folder / "g.nc", options);
  EXPECT_EQ(volume.source->geometry().points, (scene::GridIndex{2, 2, 3}));
  expect_samples(volume, {0, 6, 1, 7, 2, 8, 3, 9, 4, 10, 5, 11});
  EXPECT_EQ(scene::world_of_index(volume.source->geometry(), {1, 0, 0}), glm::dvec3(20, 0, 0));
  options.field = "/ocean/upper/t";
  EXPECT_EQ(open_volume(folder / "g.nc", options).range, (scene::ValueRange{0, 11, 0}));
}

}  // namespace
}  // namespace tessera::io::netcdf_values_test
