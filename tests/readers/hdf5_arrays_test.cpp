// SPDX-License-Identifier: BSD-3-Clause
// HDF5 files that follow no convention, and VTKHDF images, written here.
#include <gtest/gtest.h>
#include <hdf5.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <numeric>
#include <string>
#include <vector>

#include "support/read_files.hpp"
#include "support/temporary_folder.hpp"
#include "support/volume_checks.hpp"

namespace tessera::io::hdf5_arrays_test {
namespace {

using scene::GridIndex;
using test::has_note;

class Hdf5Writer {
 public:
  explicit Hdf5Writer(const std::filesystem::path& file, hsize_t user_block = 0) {
    const hid_t creation = H5Pcreate(H5P_FILE_CREATE);
    EXPECT_GE(H5Pset_userblock(creation, user_block), 0);
    file_ = H5Fcreate(file.c_str(), H5F_ACC_TRUNC, creation, H5P_DEFAULT);
    H5Pclose(creation);
  }
  ~Hdf5Writer() { EXPECT_GE(H5Fclose(file_), 0); }
  Hdf5Writer(const Hdf5Writer&) = delete;
  Hdf5Writer& operator=(const Hdf5Writer&) = delete;

  void group(const char* name) const {
    const hid_t group = H5Gcreate2(file_, name, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
    EXPECT_GE(H5Gclose(group), 0);
  }

  void array(const char* name, hid_t type, const std::vector<hsize_t>& lengths,
             const std::vector<double>& values) const {
    const hid_t space = H5Screate_simple(static_cast<int>(lengths.size()), lengths.data(), nullptr);
    const hid_t set = H5Dcreate2(file_, name, type, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
    // MINC's library, which is also in this process, registers conversions of doubles to integers that convert nothing.
    const std::vector<std::int64_t> whole(values.begin(), values.end());
    const bool is_integer = H5Tget_class(type) == H5T_INTEGER;
    EXPECT_GE(H5Dwrite(set, is_integer ? H5T_NATIVE_INT64 : H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT,
                       is_integer ? static_cast<const void*>(whole.data()) : values.data()),
              0)
        << name;
    H5Dclose(set), H5Sclose(space);
  }

  /// One chunk in a filter's packed form.
  void packed(const char* name, const std::vector<hsize_t>& lengths, H5Z_filter_t filter,
              const std::string& bytes) const {
    const hid_t space = H5Screate_simple(static_cast<int>(lengths.size()), lengths.data(), nullptr),
                creation = H5Pcreate(H5P_DATASET_CREATE);
    H5Pset_chunk(creation, static_cast<int>(lengths.size()), lengths.data());
    unsigned size = sizeof(float);
    for (const hsize_t length : lengths) size *= static_cast<unsigned>(length);
    const std::array<unsigned, 3> parameters = {4, 261, size};
    H5Pset_filter(creation, filter, H5Z_FLAG_OPTIONAL, parameters.size(), parameters.data());
    const hid_t set = H5Dcreate2(file_, name, H5T_IEEE_F32LE, space, H5P_DEFAULT, creation, H5P_DEFAULT);
    const std::vector<hsize_t> first(lengths.size(), 0);
    EXPECT_GE(H5Dwrite_chunk(set, H5P_DEFAULT, 0, first.data(), bytes.size(), bytes.data()), 0);
    H5Dclose(set), H5Pclose(creation), H5Sclose(space);
  }

  void numbers(const char* object, const char* name, const std::vector<double>& values) const {
    const hsize_t count = values.size();
    const hid_t space = H5Screate_simple(1, &count, nullptr);
    const hid_t attribute =
        H5Acreate_by_name(file_, object, name, H5T_NATIVE_DOUBLE, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
    EXPECT_GE(H5Awrite(attribute, H5T_NATIVE_DOUBLE, values.data()), 0);
    H5Aclose(attribute), H5Sclose(space);
  }

  void text(const char* object, const char* name, const std::string& value) const {
    const hid_t space = H5Screate(H5S_SCALAR), type = H5Tcopy(H5T_C_S1);
    H5Tset_size(type, value.size());
    const hid_t attribute = H5Acreate_by_name(file_, object, name, type, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
    EXPECT_GE(H5Awrite(attribute, type, value.data()), 0);
    H5Aclose(attribute), H5Sclose(space), H5Tclose(type);
  }

 private:
  hid_t file_ = H5I_INVALID_HID;
};

std::vector<double> ramp(std::size_t count, double first = 0) {
  std::vector<double> values(count);
  std::iota(values.begin(), values.end(), first);
  return values;
}

TEST(Hdf5Arrays, OfEveryTypeAreGridsOfUnitSteps) {
  const test::TemporaryFolder folder;
  for (const hid_t type : {H5T_STD_I8LE, H5T_STD_U8LE, H5T_STD_I16BE, H5T_STD_U16LE, H5T_STD_I32LE, H5T_STD_U32BE,
                           H5T_STD_I64LE, H5T_STD_U64LE, H5T_IEEE_F32LE, H5T_IEEE_F64BE}) {
    SCOPED_TRACE(::testing::Message() << "class " << H5Tget_class(type) << " of " << H5Tget_size(type)
                                      << " bytes, sign " << H5Tget_sign(type));
    {
      const Hdf5Writer w(folder / "a.h5");
      w.array("volume", type, {2, 3, 4}, ramp(24));
    }
    ASSERT_TRUE(is_volume(folder / "a.h5"));
    const VolumeFile volume = open_volume(folder / "a.h5");
    EXPECT_EQ(volume.format, "HDF5");
    EXPECT_EQ(volume.source->geometry().points, (GridIndex{4, 3, 2}));  // x is the last and fastest
    EXPECT_EQ(scene::world_of_index(volume.source->geometry(), {3, 2, 1}), glm::dvec3(3, 2, 1));
    EXPECT_EQ(test::all_samples(*volume.source), ramp(24));
  }
}

TEST(Hdf5Arrays, AreChosenByTheirPaths) {
  const test::TemporaryFolder folder;
  {
    const Hdf5Writer w(folder / "a.h5");
    w.group("exchange"), w.group("exchange/more");
    w.array("exchange/data", H5T_STD_U16LE, {2, 2, 3}, ramp(12));
    w.array("exchange/more/dark", H5T_IEEE_F32LE, {2, 2, 2}, ramp(8, 100));
    w.array("exchange/theta", H5T_IEEE_F64LE, {5}, ramp(5));
  }
  const VolumeFile first = open_volume(folder / "a.h5");
  EXPECT_EQ(first.range, (scene::ValueRange{0, 11, 0}));
  EXPECT_TRUE(has_note(first, "another grid, of 2 x 2 x 2 samples, is exchange/more/dark"));
  ReadOptions options;
  for (const char* name : {"exchange/more/dark", "/exchange/more/dark"}) {
    options.field = name;
    EXPECT_EQ(open_volume(folder / "a.h5", options).range, (scene::ValueRange{100, 107, 0}));
  }
  options.field = "exchange/light";
  test::expect_no_volume(folder / "a.h5", "no field 'exchange/light'", options);
}

TEST(Hdf5Arrays, OfMoreAxesHaveStepsAndComponents) {
  const test::TemporaryFolder folder;
  {
    const Hdf5Writer w(folder / "steps.h5");
    w.array("v", H5T_STD_I32LE, {3, 2, 2, 5}, ramp(60));
  }
  ReadOptions options;
  for (const std::size_t step : {0, 1, 2}) {
    options.time_step = step;
    EXPECT_EQ(test::all_samples(*open_volume(folder / "steps.h5", options).source),
              ramp(20, 20 * static_cast<double>(step)));
  }
  EXPECT_TRUE(has_note(open_volume(folder / "steps.h5", options), "time steps are counted along the first dim"));
  options.time_step = 3;
  test::expect_no_volume(folder / "steps.h5", "there is no time step 3, the file has 3", options);
  {
    const Hdf5Writer w(folder / "vectors.h5");
    w.array("v", H5T_IEEE_F32LE, {5, 2, 6, 2}, ramp(120));
  }
  options = {};
  options.field = "v:1";
  const VolumeFile second = open_volume(folder / "vectors.h5", options);
  EXPECT_EQ(second.source->geometry().points, (GridIndex{6, 2, 5}));
  EXPECT_EQ(second.range, (scene::ValueRange{1, 119, 0}));
  EXPECT_TRUE(has_note(second, "the last dimension of v, of size 2, is used for components"));
}

TEST(Hdf5Arrays, MayHaveALastDimensionOfOne) {
  const test::TemporaryFolder folder;
  for (const std::vector<hsize_t>& lengths : {std::vector<hsize_t>{2, 3, 4, 1}, {1, 2, 3, 4, 1}}) {
    {
      const Hdf5Writer w(folder / "a.h5");
      w.array("v", H5T_IEEE_F32LE, lengths, ramp(24));
    }
    const VolumeFile volume = open_volume(folder / "a.h5");
    EXPECT_EQ(volume.source->geometry().points, (GridIndex{4, 3, 2}));
    EXPECT_EQ(test::all_samples(*volume.source), ramp(24));
    EXPECT_FALSE(has_note(volume, "components"));
  }
}

TEST(Hdf5Arrays, MayFollowAUserBlock) {
  const test::TemporaryFolder folder;
  for (const hsize_t block : {512, 1024, 2048, 4096, 65536})
    for (const char* name : {"a.h5", "a", "a.nc", "a.e", "a.mnc", "a.vtkhdf", "a.cgns"}) {
      SCOPED_TRACE(name);
      {
        const Hdf5Writer w(folder / name, block);
        w.array("v", H5T_IEEE_F32LE, {2, 3, 4}, ramp(24));
      }
      ASSERT_TRUE(is_volume(folder / name)) << block;
      EXPECT_EQ(test::all_samples(*open_volume(folder / name).source), ramp(24));
    }
}

TEST(Hdf5Arrays, MissingValuesAreBlank) {
  const test::TemporaryFolder folder;
  {
    const Hdf5Writer w(folder / "a.h5");
    std::vector<double> values = ramp(8);
    values[3] = -9999;
    w.array("v", H5T_STD_I16LE, {2, 2, 2}, values);
    w.numbers("v", "_FillValue", {-9999});
  }
  EXPECT_EQ(open_volume(folder / "a.h5").range, (scene::ValueRange{0, 7, 1}));
}

/// LibLZF's LZF for its decoder: literal bytes, or repeats of the bytes four before.
std::string lzf(const std::string& plain) {
  std::string packed, literal;
  const auto end_literal = [&] {
    if (!literal.empty()) packed += static_cast<char>(literal.size() - 1) + literal;
    literal.clear();
  };
  for (std::size_t at = 0; at < plain.size();) {
    std::size_t same = 0;
    while (at >= 4 && at + same < plain.size() && same < 264 && plain[at + same] == plain[at + same - 4]) ++same;
    if (same >= 3) {
      end_literal();
      const std::size_t length = same - 2;
      packed += static_cast<char>(std::min<std::size_t>(length, 7) << 5);  // with the distance's high bits, zero
      if (length >= 7) packed += static_cast<char>(length - 7);
      packed += static_cast<char>(3);  // one less than the distance
      at += same;
    } else {
      literal += plain[at++];
      if (literal.size() == 32) end_literal();
    }
  }
  end_literal();
  return packed;
}

TEST(Hdf5Arrays, PackedByLzfAreReadAndByOthersRefusedByName) {
  const test::TemporaryFolder folder;
  std::vector<float> values(4 * 5 * 60);
  for (std::size_t k = 0; k < values.size(); ++k)
    values[k] = k < 400 ? static_cast<float>(k) * 1.25F : static_cast<float>(k / 100);
  std::string plain(values.size() * sizeof(float), '\0');
  std::memcpy(plain.data(), values.data(), plain.size());
  const std::string packed = lzf(plain);
  ASSERT_LT(packed.size(), plain.size());
  {
    const Hdf5Writer w(folder / "lzf.h5");
    w.packed("v", {4, 5, 60}, 32000, packed);
  }
  EXPECT_EQ(test::all_samples(*open_volume(folder / "lzf.h5").source),
            std::vector<double>(values.begin(), values.end()));
  {
    const Hdf5Writer w(folder / "cut.h5");
    w.packed("v", {4, 5, 60}, 32000, packed.substr(0, packed.size() / 2));
  }
  test::expect_no_volume(folder / "cut.h5", "'v' cannot be read; the file is truncated or damaged");
  {
    const Hdf5Writer w(folder / "other.h5");
    w.packed("v", {4, 5, 60}, 32015, "zstd");
  }
  test::expect_no_volume(folder / "other.h5", "(32015), which is not installed here; unpack it with h5repack -f NONE");
}

TEST(Hdf5Arrays, WithoutThreeDimensionsAreRefused) {
  const test::TemporaryFolder folder;
  {
    const Hdf5Writer w(folder / "flat.h5");
    w.array("image", H5T_IEEE_F32LE, {4, 4}, ramp(16));
  }
  EXPECT_EQ(test::fault_of([&] { read_mesh(folder / "flat.h5"); }).code, scene::ErrorCode::bad_input);
  test::expect_no_volume(folder / "flat.h5", "without a three-dimensional array of numbers");
}

/// An image of 4 x 3 x 2 points whose indices begin at (10, 0, -1).
void write_image(const Hdf5Writer& w) {
  w.group("VTKHDF"), w.group("VTKHDF/PointData"), w.group("VTKHDF/CellData");
  w.numbers("VTKHDF", "Version", {2, 0});
  w.text("VTKHDF", "Type", "ImageData");
  w.numbers("VTKHDF", "WholeExtent", {10, 13, 0, 2, -1, 0});
  w.numbers("VTKHDF", "Origin", {100, 200, 300});
  w.numbers("VTKHDF", "Spacing", {1, 2, 3});
  w.numbers("VTKHDF", "Direction", {0, -1, 0, 1, 0, 0, 0, 0, 1});  // x points along y, y along -x
}

TEST(VtkHdfImages, AreGridsWithTheirAxes) {
  const test::TemporaryFolder folder;
  {
    const Hdf5Writer w(folder / "a.vtkhdf");
    write_image(w);
    w.array("VTKHDF/PointData/f", H5T_IEEE_F32LE, {2, 3, 4}, ramp(24));
    w.array("VTKHDF/PointData/u", H5T_IEEE_F64LE, {2, 3, 4, 3}, ramp(72));
    w.array("VTKHDF/CellData/c", H5T_STD_U8LE, {1, 2, 3}, ramp(6));
  }
  ASSERT_TRUE(is_volume(folder / "a.vtkhdf"));
  ReadOptions options;
  options.field = "f";
  const VolumeFile volume = open_volume(folder / "a.vtkhdf", options);
  EXPECT_EQ(volume.format, "VTKHDF");
  const scene::GridGeometry& g = volume.source->geometry();
  EXPECT_EQ(g.points, (GridIndex{4, 3, 2}));
  EXPECT_EQ(scene::world_of_index(g, {0, 0, 0}), glm::dvec3(100, 210, 297));
  EXPECT_EQ(scene::world_of_index(g, {1, 1, 1}), glm::dvec3(98, 211, 300));
  EXPECT_EQ(test::all_samples(*volume.source), ramp(24));
  options.field = "u:y";
  EXPECT_EQ(open_volume(folder / "a.vtkhdf", options).range, (scene::ValueRange{1, 70, 0}));
  options.field = "cell:c";
  EXPECT_EQ(test::all_samples(*open_volume(folder / "a.vtkhdf", options).source), ramp(6));
}

TEST(VtkHdfImages, HaveTimeSteps) {
  const test::TemporaryFolder folder;
  {
    const Hdf5Writer w(folder / "t.vtkhdf");
    write_image(w);
    w.array("VTKHDF/PointData/f", H5T_IEEE_F32LE, {2, 2, 3, 4}, ramp(48));
    w.group("VTKHDF/Steps"), w.group("VTKHDF/Steps/PointDataOffsets");
    w.numbers("VTKHDF/Steps", "NSteps", {3});
    w.array("VTKHDF/Steps/Values", H5T_IEEE_F64LE, {3}, {0, 0.5, 1});
    // The third step has the data of the first.
    w.array("VTKHDF/Steps/PointDataOffsets/f", H5T_STD_I64LE, {3}, {0, 1, 0});
  }
  ReadOptions options;
  for (const std::size_t step : {0, 1, 2}) {
    options.time_step = step;
    const VolumeFile read = open_volume(folder / "t.vtkhdf", options);
    EXPECT_EQ(test::all_samples(*read.source), ramp(24, step == 1 ? 24 : 0));
    EXPECT_EQ(read.time_step.times, (std::vector<double>{0, 0.5, 1}));
  }
  EXPECT_EQ(open_volume(folder / "t.vtkhdf").time_step.times, (std::vector<double>{0, 0.5, 1}));
}

TEST(VtkHdfImages, RefusesDamagedFiles) {
  const test::TemporaryFolder folder;
  {
    const Hdf5Writer w(folder / "d.vtkhdf");
    w.group("VTKHDF");
    w.text("VTKHDF", "Type", "ImageData");
  }
  test::expect_no_volume(folder / "d.vtkhdf", "its image has no WholeExtent of six numbers");
}

}  // namespace
}  // namespace tessera::io::hdf5_arrays_test
