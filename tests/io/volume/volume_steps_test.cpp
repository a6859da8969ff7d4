// SPDX-License-Identifier: BSD-3-Clause
// Volumes of several steps, in several files, and with a separate header.
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <zlib.h>

#include <cmath>
#include <cstring>
#include <filesystem>
#include <string>
#include <vector>

#include "io/formats/identify.hpp"
#include "support/read_files.hpp"
#include "support/temporary_folder.hpp"
#include "support/volume_bytes.hpp"
#include "support/volume_checks.hpp"

namespace tessera::io {
namespace {

using scene::GridIndex;
using test::all_samples;
using test::bytes_of;
using test::counting;
using test::expect_no_volume;
using test::has_note;
using test::put;

/// Samples first, first + step, ...
std::vector<double> from(double first, double step = 1, std::size_t count = 24) {
  std::vector<double> values(count);
  for (std::size_t k = 0; k < count; ++k) values[k] = first + step * static_cast<double>(k);
  return values;
}

std::string gzip(const std::string& bytes) {
  z_stream stream{};
  std::string packed(bytes.size() + 256, '\0');
  deflateInit2(&stream, 6, Z_DEFLATED, 15 + 16, 8, Z_DEFAULT_STRATEGY);
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(bytes.data()));
  stream.avail_in = static_cast<uInt>(bytes.size());
  stream.next_out = reinterpret_cast<Bytef*>(packed.data());
  stream.avail_out = static_cast<uInt>(packed.size());
  EXPECT_EQ(deflate(&stream, Z_FINISH), Z_STREAM_END);
  packed.resize(stream.total_out);
  deflateEnd(&stream);
  return packed;
}

class VolumeSteps : public ::testing::Test {
 protected:
  std::vector<double> samples(const std::filesystem::path& file, const ReadOptions& options = {}) {
    return all_samples(*open_volume(file, options).source);
  }
  /// Three steps, 0 to 23, 24 to 47 and 48 to 71.
  static std::string three_steps() {
    std::string file = test::nifti_header();
    put<std::int16_t>(file, 40, 4);
    put<std::int16_t>(file, 48, 3);
    return file + bytes_of(counting<std::int16_t>(72));
  }
  test::TemporaryFolder folder;
};

TEST_F(VolumeSteps, NiftiShowsItsLastStepOrTheOneNamed) {
  for (const auto& file : {folder.write("a.nii", three_steps()), folder.write("a.nii.gz", gzip(three_steps()))}) {
    const VolumeFile last = open_volume(file);
    EXPECT_EQ(last.source->geometry().points, (GridIndex{4, 3, 2}));
    EXPECT_EQ(all_samples(*last.source), from(48));
    EXPECT_EQ(last.time_step.step, 2u);
    EXPECT_EQ(last.range, (scene::ValueRange{48, 71, 0}));
    EXPECT_EQ(samples(file, {.time_step = 0}), from(0));
    EXPECT_EQ(samples(file, {.time_step = 1}), from(24));
    expect_no_volume(file, "no time step 3, the file has 3", {.time_step = 3});
  }
  const auto one = folder.write("one.nii", test::nifti());
  EXPECT_EQ(samples(one, {.time_step = 0}), from(0));
  expect_no_volume(one, "no time step 1", {.time_step = 1});
  const auto cut = folder.write("cut.nii", three_steps().substr(0, 352 + 2 * 60));
  EXPECT_EQ(samples(cut, {.time_step = 1}), from(24));
  expect_no_volume(cut, "truncated");
}

TEST_F(VolumeSteps, NiftiStatesTimesInItsUnit) {
  struct Unit {
    std::int8_t code;
    std::vector<double> times;
  };
  // The units are seconds, milliseconds, hertz (not a time), and millimetres without a unit of time.
  for (const Unit& unit : {Unit{8 + 2, {1, 3.5, 6}}, Unit{16, {0.001, 0.0035, 0.006}}, Unit{32, {}}, Unit{2, {}}}) {
    std::string file = three_steps();
    put<float>(file, 92, 2.5f);
    put<float>(file, 136, 1);
    put<std::int8_t>(file, 123, unit.code);
    const auto times = open_volume(folder.write("t.nii", file), {.time_step = 1}).time_step.times;
    ASSERT_EQ(times.size(), unit.times.size()) << int{unit.code};
    for (std::size_t k = 0; k < times.size(); ++k) EXPECT_DOUBLE_EQ(times[k], unit.times[k]);
  }
}

TEST_F(VolumeSteps, NrrdStatesTimesAlongTheirAxis) {
  const auto times = [&](const std::string& about) {
    const auto file = folder.write("t.nrrd", "NRRD0004\ntype: short\nencoding: raw\nendian: little\ndimension: 4\n" +
                                                 about + "\n\n" + bytes_of(counting<std::int16_t>(72)));
    return open_volume(file).time_step.times;
  };
  const std::string last = "sizes: 4 3 2 3\nkinds: domain domain domain time\n";
  EXPECT_EQ(times(last + "spacings: 1 1 1 0.5\naxis mins: 0 0 0 2"), (std::vector<double>{2, 2.5, 3}));
  EXPECT_EQ(times(last + "axis mins: 0 0 0 2\naxis maxs: 3 2 1 6"), (std::vector<double>{2, 4, 6}));
  EXPECT_EQ(times("sizes: 3 4 3 2\nkinds: time domain domain domain\nspacings: 0.25 1 1 1"),
            (std::vector<double>{0, 0.25, 0.5}));
  EXPECT_TRUE(times(last + "spacings: 1 1 1 nan").empty());
  EXPECT_TRUE(times("sizes: 3 4 3 2\nkinds: list domain domain domain\nspacings: 0.25 1 1 1").empty());
}

TEST_F(VolumeSteps, NiftiVectorsAreInPlanes) {
  std::string file = test::nifti_header();
  put<std::int16_t>(file, 40, 5);
  put<std::int16_t>(file, 50, 3);
  file += bytes_of(counting<std::int16_t>(72));
  const auto named = folder.write("warp.nii", file);
  for (int c = 0; c < 3; ++c) EXPECT_EQ(samples(named, {.field = fmt::format("samples:{}", c)}), from(24.0 * c));
  EXPECT_NEAR(samples(named)[1], std::sqrt(1.0 + 25.0 * 25 + 49.0 * 49), 1e-5);  // stored as floats
  put<std::int16_t>(file, 48, 2);
  expect_no_volume(folder.write("both.nii", file), "3 components and dimension 4 has 2 time steps");
}

TEST_F(VolumeSteps, HeaderAndSamplesMayBeTwoFiles) {
  std::string header = test::nifti_header();
  std::memcpy(header.data() + 344, "ni1", 4);
  put<float>(header, 108, 8);
  put<float>(header, 112, 2);
  const std::string image = std::string(8, 'x') + bytes_of(counting<std::int16_t>(24));
  const auto pair = folder.write("pair.hdr", header);
  expect_no_volume(pair, "pair.img, which does not exist");
  folder.write("pair.img", image);
  for (const auto& file : {pair, folder / "pair.img"}) {
    const VolumeFile volume = open_volume(file);
    EXPECT_EQ(all_samples(*volume.source), from(0));
    EXPECT_EQ(volume.range, (scene::ValueRange{0, 46, 0}));
    EXPECT_EQ(volume.format, "NIfTI-1");
  }
  // An Analyze header has no magic word. This one has the other byte order, and its samples are packed.
  header.resize(348);
  std::fill(header.begin() + 80, header.end(), '\0');
  put<std::int32_t>(header, 0, 348);
  const float spacing[] = {-1, 2, 0};
  std::memcpy(header.data() + 80, spacing, sizeof spacing);
  const auto analyze = folder.write("old.hdr", header);
  const auto packed = folder.write("old.img.gz", gzip(bytes_of(counting<std::int16_t>(24))));
  EXPECT_STREQ(identify(analyze).format->name, "Analyze 7.5");
  for (const auto& file : {analyze, packed}) {
    const VolumeFile volume = open_volume(file);
    EXPECT_EQ(all_samples(*volume.source), from(0));
    EXPECT_EQ(volume.source->geometry().spacing, glm::dvec3(1, 2, 1));
    EXPECT_TRUE(has_note(volume, "left and right"));
  }
  expect_no_volume(folder.write("lone.img", image), "lone.hdr does not exist");
  expect_no_volume(folder.write("text.hdr", "ENVI\nsamples = 3\n"), "348");
}

TEST_F(VolumeSteps, NrrdTimeIsItsLastAxisOrAListBeforeTheOthers) {
  const auto write = [&](const char* name, const std::string& about) {
    return folder.write(name, "NRRD0004\ntype: short\nencoding: raw\nendian: little\n" + about + "\n\n" +
                                  bytes_of(counting<std::int16_t>(72)));
  };
  const auto last = write("last.nrrd", "dimension: 4\nsizes: 4 3 2 3\nkinds: domain domain domain time");
  EXPECT_EQ(samples(last), from(48));
  EXPECT_EQ(samples(last, {.time_step = 1}), from(24));
  const auto by_directions = write(
      "dirs.nrrd", "dimension: 4\nsizes: 4 3 2 3\nspace dimension: 3\nspace directions: (1,0,0) (0,1,0) (0,0,1) none");
  EXPECT_EQ(samples(by_directions, {.time_step = 0}), from(0));
  const auto list = write("list.nrrd", "dimension: 4\nsizes: 3 4 3 2\nkinds: list domain domain domain");
  EXPECT_EQ(samples(list, {.time_step = 1}), from(1, 3));
  EXPECT_EQ(samples(list), from(2, 3));
  const auto vectors = write("vectors.nrrd", "dimension: 4\nsizes: 3 4 3 2\nkinds: vector domain domain domain");
  EXPECT_EQ(samples(vectors, {.field = "samples:1"}), from(1, 3));
  const auto both = write("both.nrrd", "dimension: 5\nsizes: 2 3 3 2 2");
  EXPECT_EQ(samples(both, {.field = "samples:1", .time_step = 1}), from(37, 2, 18));
  expect_no_volume(write("six.nrrd", "dimension: 6\nsizes: 1 2 3 3 2 2"), "6 dimensions");
}

TEST_F(VolumeSteps, SlicesInFilesAreOneVolume) {
  const std::string all = bytes_of(counting<std::int16_t>(24));
  for (int k = 0; k < 2; ++k) {
    folder.write(fmt::format("s{:03}.raw", k + 7), "head" + all.substr(static_cast<std::size_t>(k) * 24, 24));
    folder.write(fmt::format("s{}.gz", k), gzip(all.substr(static_cast<std::size_t>(k) * 24, 24)));
  }
  const std::string nrrd = "NRRD0004\ntype: short\nendian: little\ndimension: 3\nsizes: 4 3 2\n";
  const std::string meta = "NDims = 3\nDimSize = 4 3 2\nElementType = MET_SHORT\n";
  EXPECT_EQ(samples(folder.write("p.nhdr", nrrd + "encoding: raw\nbyte skip: 4\ndata file: s%03d.raw 7 8 1\n")),
            from(0));
  EXPECT_EQ(
      samples(folder.write("l.nhdr", nrrd + "encoding: raw\nbyte skip: -1\ndata file: LIST\ns007.raw\ns008.raw\n")),
      from(0));
  EXPECT_EQ(samples(folder.write("g.nhdr", nrrd + "encoding: gzip\ndata file: LIST 2\ns0.gz\ns1.gz\n")), from(0));
  EXPECT_EQ(samples(folder.write("p.mhd", meta + "HeaderSize = 4\nElementDataFile = s%03d.raw 7 8 1\n")), from(0));
  EXPECT_EQ(samples(folder.write("l.mhd", meta + "HeaderSize = -1\nElementDataFile = LIST 2D\ns007.raw\ns008.raw\n")),
            from(0));
  // In reverse order.
  EXPECT_EQ(samples(folder.write("r.mhd", meta + "HeaderSize = 4\nElementDataFile = s%03d.raw 8 7 -1\n")).front(), 12);
  expect_no_volume(folder.write("absent.mhd", meta + "ElementDataFile = s%03d.raw 7 9 1\n"), "s009.raw");
  expect_no_volume(folder.write("none.mhd", meta + "ElementDataFile = LIST\n"), "no names follow");
  expect_no_volume(folder.write("odd.mhd", meta + "ElementDataFile = s%s.raw 7 8 1\n"), "FIRST LAST");
  expect_no_volume(folder.write("many.mhd", meta + "ElementDataFile = s%03d.raw 7 7 0\n"), "in steps of 0");
  expect_no_volume(folder.write("short.mhd", meta + "HeaderSize = 8\nElementDataFile = LIST\ns007.raw\ns008.raw\n"),
                   "is 24 bytes, but the file has 20 after its first 8");
  std::string long_list = "NDims = 3\nDimSize = 4 2 1\nElementType = MET_SHORT\nElementDataFile = LIST\n";
  for (int k = 0; k < 9; ++k) long_list += "s007.raw\n";
  expect_no_volume(folder.write("long.mhd", long_list), "more files than there are slices (2)");
}

TEST_F(VolumeSteps, MetaImageOfFourDimensionsHasTime) {
  const std::string file =
      "NDims = 4\nDimSize = 4 3 2 3\nElementSpacing = 1 2 3 0.5\nOffset = 5 6 7 2\n"
      "TransformMatrix = 0 1 0 0 -1 0 0 0 0 0 1 0 0 0 0 1\nElementType = MET_SHORT\n"
      "ElementDataFile = LOCAL\n" +
      bytes_of(counting<std::int16_t>(72));
  const VolumeFile volume = open_volume(folder.write("a.mha", file), {.time_step = 1});
  EXPECT_EQ(volume.time_step.times, (std::vector<double>{2, 2.5, 3}));
  EXPECT_EQ(all_samples(*volume.source), from(24));
  EXPECT_EQ(volume.source->geometry().spacing, glm::dvec3(1, 2, 3));
  EXPECT_EQ(volume.source->geometry().origin, glm::dvec3(5, 6, 7));
  EXPECT_EQ(volume.source->geometry().direction[0], glm::dvec3(0, 1, 0));
}

}  // namespace
}  // namespace tessera::io
