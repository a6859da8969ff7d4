// SPDX-License-Identifier: BSD-3-Clause
// MINC 2 volumes, written by MINC's library.
extern "C" {
#include <minc2.h>
}
#include <gtest/gtest.h>

#include <array>
#include <vector>

#include "io/volume/volume_formats.hpp"
#include "support/changed_bytes.hpp"
#include "support/marker.hpp"
#include "support/read_files.hpp"
#include "support/temporary_folder.hpp"
#include "support/volume_checks.hpp"

namespace tessera::io::minc2_test {
namespace {

using scene::GridIndex;

struct AxisOfFile {
  const char* name;
  misize_t size;
  double start, step;
  std::array<double, 3> cosines;
};

/// The samples 0, 1, ... of a volume of 2 x 3 x 4, in the order of the file's axes; if `steps` > 1, of this many
/// volumes.
void write_minc2(const std::string& name, misize_t steps) {
  // The file's order is not z, y, x.
  const std::array<AxisOfFile, 3> axes = {AxisOfFile{"yspace", 3, 20, -2, {-1, 0, 0}},
                                          AxisOfFile{"zspace", 2, 30, 3, {0, 0, 1}},
                                          AxisOfFile{"xspace", 4, 10, 0.5, {0, 1, 0}}};
  std::vector<midimhandle_t> dimensions;
  std::vector<misize_t> first, counts;
  if (steps > 1) {
    ASSERT_EQ(
        micreate_dimension("time", MI_DIMCLASS_TIME, MI_DIMATTR_REGULARLY_SAMPLED, steps, &dimensions.emplace_back()),
        MI_NOERROR);
    miset_dimension_start(dimensions.back(), 3);
    miset_dimension_separation(dimensions.back(), 1.5);
    first.push_back(0), counts.push_back(steps);
  }
  for (const AxisOfFile& axis : axes) {
    midimhandle_t& dimension = dimensions.emplace_back();
    ASSERT_EQ(micreate_dimension(axis.name, MI_DIMCLASS_SPATIAL, MI_DIMATTR_REGULARLY_SAMPLED, axis.size, &dimension),
              MI_NOERROR);
    miset_dimension_start(dimension, axis.start);
    miset_dimension_separation(dimension, axis.step);
    std::array<double, 3> cosines = axis.cosines;
    miset_dimension_cosines(dimension, cosines.data());
    first.push_back(0), counts.push_back(axis.size);
  }
  mihandle_t volume = nullptr;
  ASSERT_EQ(micreate_volume(name.c_str(), static_cast<int>(dimensions.size()), dimensions.data(), MI_TYPE_SHORT,
                            MI_CLASS_REAL, nullptr, &volume),
            MI_NOERROR);
  ASSERT_EQ(micreate_volume_image(volume), MI_NOERROR);
  miset_volume_valid_range(volume, 1000, 0);
  miset_volume_range(volume, 505, 5);  // real = 5 + sample / 2
  std::vector<short> samples(24 * steps);
  for (std::size_t k = 0; k < samples.size(); ++k) samples[k] = static_cast<short>(k);
  ASSERT_EQ(miset_voxel_value_hyperslab(volume, MI_TYPE_SHORT, first.data(), counts.data(), samples.data()),
            MI_NOERROR);
  ASSERT_EQ(miclose_volume(volume), MI_NOERROR);
}

TEST(Minc2, RealValuesArePlacedByTheDirectionCosines) {
  const test::TemporaryFolder folder;
  write_minc2((folder / "head.mnc").string(), 1);
  ASSERT_TRUE(is_volume(folder / "head.mnc"));
  const VolumeFile volume = open_volume(folder / "head.mnc");
  EXPECT_EQ(volume.format, "MINC 2");
  const scene::GridGeometry& g = volume.source->geometry();
  ASSERT_EQ(g.points, (GridIndex{4, 3, 2}));
  const std::vector<double> samples = test::all_samples(*volume.source);
  for (int k = 0; k < 2; ++k)
    for (int j = 0; j < 3; ++j)
      for (int i = 0; i < 4; ++i) {
        const glm::dvec3 place = scene::world_of_index(g, {i, j, k});
        EXPECT_NEAR(place.x, -(20 - 2 * j), 1e-12);
        EXPECT_NEAR(place.y, 10 + 0.5 * i, 1e-12);
        EXPECT_NEAR(place.z, 30 + 3 * k, 1e-12);
        // In the file, x is the fastest axis, then z, then y. A float represents the sum of an integer and a half
        // exactly.
        EXPECT_EQ(samples[static_cast<std::size_t>(i + 4 * (j + 3 * k))], 5 + (i + 4 * (k + 2 * j)) / 2.0);
      }
}

/// Samples in the order of `axes`, the slowest first.
void write_marked(const std::filesystem::path& file, const std::vector<AxisOfFile>& axes,
                  const std::vector<std::int16_t>& samples) {
  std::vector<midimhandle_t> dimensions;
  const std::vector<misize_t> first(axes.size(), 0);
  std::vector<misize_t> counts;
  for (const AxisOfFile& axis : axes) {
    midimhandle_t& dimension = dimensions.emplace_back();
    ASSERT_EQ(micreate_dimension(axis.name, MI_DIMCLASS_SPATIAL, MI_DIMATTR_REGULARLY_SAMPLED, axis.size, &dimension),
              MI_NOERROR);
    miset_dimension_start(dimension, axis.start);
    miset_dimension_separation(dimension, axis.step);
    std::array<double, 3> cosines = axis.cosines;
    miset_dimension_cosines(dimension, cosines.data());
    counts.push_back(axis.size);
  }
  mihandle_t volume = nullptr;
  ASSERT_EQ(micreate_volume(file.c_str(), static_cast<int>(dimensions.size()), dimensions.data(), MI_TYPE_SHORT,
                            MI_CLASS_REAL, nullptr, &volume),
            MI_NOERROR);
  ASSERT_EQ(micreate_volume_image(volume), MI_NOERROR);
  miset_volume_valid_range(volume, 1000, 0);
  miset_volume_range(volume, 1000, 0);
  std::vector<short> written(samples.begin(), samples.end());
  ASSERT_EQ(miset_voxel_value_hyperslab(volume, MI_TYPE_SHORT, first.data(), counts.data(), written.data()),
            MI_NOERROR);
  ASSERT_EQ(miclose_volume(volume), MI_NOERROR);
}

/// The file's axis a is named x, y or z by its direction, or by its number and rotated by its cosines.
std::vector<AxisOfFile> marked_axes(const test::MarkedVolume& v, bool turns) {
  constexpr std::array names = {"xspace", "yspace", "zspace"};
  std::vector<AxisOfFile> axes;
  for (int a = 2; a >= 0; --a) {
    const glm::dvec3 along = v.axes[a];
    const int world = along.x != 0 ? 0 : along.y != 0 ? 1 : 2;
    AxisOfFile axis{names[static_cast<std::size_t>(turns ? a : world)],
                    static_cast<misize_t>(v.size[static_cast<std::size_t>(a)]),
                    0,
                    0,
                    {}};
    if (turns) {
      axis.start = glm::dot(along, v.origin), axis.step = v.spacing[a];
      axis.cosines = {along.x, along.y, along.z};
    } else {
      axis.start = v.origin[world], axis.step = v.spacing[a] * along[world];
      axis.cosines[static_cast<std::size_t>(world)] = 1;
    }
    axes.push_back(axis);
  }
  return axes;
}

TEST(Minc2, LeftIsLeftInAllOrientations) {
  const test::TemporaryFolder folder;
  const auto write = [&](const char* name, bool turns) {
    return [&folder, name, turns](const test::MarkedVolume& v) {
      std::filesystem::remove(folder / name);
      write_marked(folder / name, marked_axes(v, turns), v.samples());
      return folder / name;
    };
  };
  test::expect_markers({{"MINC cosines", write("c.mnc", true)}, {"MINC steps", write("s.mnc", false)}});
}

TEST(Minc2, TimeStepsAreChosen) {
  const test::TemporaryFolder folder;
  write_minc2((folder / "f.mnc").string(), 2);
  EXPECT_EQ(open_volume(folder / "f.mnc").range, (scene::ValueRange{5 + 12, 5 + 23.5, 0}));
  EXPECT_EQ(open_volume(folder / "f.mnc").time_step.times, (std::vector<double>{3, 4.5}));
  ReadOptions options;
  options.time_step = 0;
  EXPECT_EQ(open_volume(folder / "f.mnc", options).range, (scene::ValueRange{5, 5 + 11.5, 0}));
  options.time_step = 2;
  test::expect_no_volume(folder / "f.mnc", "there is no time step 2", options);
}

/// Three bytes per sample; except for these, x is the fastest axis. If `steps` > 1, this many volumes.
void write_minc2_vectors(const std::string& name, misize_t steps) {
  std::vector<midimhandle_t> dimensions;
  std::vector<misize_t> first, counts;
  const auto add = [&](const char* axis, midimclass_t kind, misize_t size) {
    ASSERT_EQ(micreate_dimension(axis, kind, MI_DIMATTR_REGULARLY_SAMPLED, size, &dimensions.emplace_back()),
              MI_NOERROR);
    first.push_back(0), counts.push_back(size);
  };
  if (steps > 1) add("time", MI_DIMCLASS_TIME, steps);
  add("zspace", MI_DIMCLASS_SPATIAL, 2), add("yspace", MI_DIMCLASS_SPATIAL, 3), add("xspace", MI_DIMCLASS_SPATIAL, 4);
  add("vector_dimension", MI_DIMCLASS_RECORD, 3);
  mihandle_t volume = nullptr;
  ASSERT_EQ(micreate_volume(name.c_str(), static_cast<int>(dimensions.size()), dimensions.data(), MI_TYPE_UBYTE,
                            MI_CLASS_REAL, nullptr, &volume),
            MI_NOERROR);
  ASSERT_EQ(micreate_volume_image(volume), MI_NOERROR);
  miset_volume_valid_range(volume, 255, 0);
  miset_volume_range(volume, 255, 0);
  std::vector<unsigned char> samples(72 * steps);
  for (std::size_t k = 0; k < samples.size(); ++k) samples[k] = static_cast<unsigned char>(k);
  ASSERT_EQ(miset_voxel_value_hyperslab(volume, MI_TYPE_UBYTE, first.data(), counts.data(), samples.data()),
            MI_NOERROR);
  ASSERT_EQ(miclose_volume(volume), MI_NOERROR);
}

TEST(Minc2, VectorsHaveComponents) {
  const test::TemporaryFolder folder;
  for (const misize_t steps : {1, 2}) {
    write_minc2_vectors((folder / "v.mnc").string(), steps);
    ASSERT_TRUE(is_volume(folder / "v.mnc"));
    ReadOptions options;
    for (const int component : {0, 1, 2}) {
      options.field = "image:" + std::to_string(component);
      const VolumeFile volume = open_volume(folder / "v.mnc", options);
      EXPECT_EQ(volume.source->geometry().points, (GridIndex{4, 3, 2}));
      const std::vector<double> samples = test::all_samples(*volume.source);
      ASSERT_EQ(samples.size(), 24u);
      for (std::size_t k = 0; k < 24; ++k)  // of the last step
        EXPECT_NEAR(samples[k], static_cast<double>(72 * (steps - 1) + 3 * k) + component, 1e-4);
    }
  }
}

TEST(Minc2, RefusesDamagedFilesInOneLine) {
  const test::TemporaryFolder folder;
  write_minc2((folder / "head.mnc").string(), 1);
  const std::string whole = test::contents(folder / "head.mnc");
  for (const std::size_t size : {whole.size() - 60, whole.size() / 2}) {
    const auto cut = folder.write("cut.mnc", whole.substr(0, size));
    test::expect_bad_input([&] { read_mesh(cut); }, {"cut.mnc: ", "; "});
  }
  test::expect_no_crash_of_changes(folder, "changed.mnc", whole, [](const std::filesystem::path& file) {
    if (is_volume(file))
      open_volume(file);
    else
      read_mesh(file);
  });
}

}  // namespace
}  // namespace tessera::io::minc2_test
