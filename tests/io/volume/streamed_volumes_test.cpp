// SPDX-License-Identifier: BSD-3-Clause
// Volumes that are unpacked a part at a time into an unnamed file instead of into memory.
#include <gtest/gtest.h>

#include <cstring>

#include "io/volume/brick_file.hpp"
#include "io/volume/streamed_bricks.hpp"
#include "support/read_files.hpp"
#include "support/scratch_folder.hpp"
#include "support/streamed_fixture.hpp"
#include "support/volume_bytes.hpp"
#include "support/volume_checks.hpp"
#include "support/vtk_grid_files.hpp"

namespace tessera::io {
namespace {

using test::all_samples;
using test::noise;
using test::nx;
using test::ny;
using test::nz;
using test::samples;
using test::StreamedVolumes;

std::string nifti_of(std::int16_t type, int bytes_each, std::int16_t steps = 1) {
  std::string header = test::nifti_header();
  const std::int16_t dim[] = {static_cast<std::int16_t>(steps > 1 ? 4 : 3), nx, ny, nz, steps, 1, 1, 1};
  std::memcpy(header.data() + 40, dim, sizeof dim);
  test::put<std::int16_t>(header, 70, type);
  test::put<float>(header, 112, 2.5f);
  test::put<float>(header, 116, -1.0f);
  return header + noise(samples * static_cast<std::size_t>(bytes_each) * static_cast<std::size_t>(steps));
}

TEST_F(StreamedVolumes, OfGzipMatchThoseInMemory) {
  EXPECT_TRUE(is_the_same_streamed(zipped("bytes.nii.gz", nifti_of(2, 1))));
  EXPECT_TRUE(is_the_same_streamed(zipped("doubles.nii.gz", nifti_of(64, 8))));
  EXPECT_TRUE(is_the_same_streamed(zipped("steps.nii.gz", nifti_of(4, 2, 3))));
  // The file has several gzip members, and zeros after the last one.
  const std::string whole = nifti_of(2, 1);
  const std::string first = test::contents(zipped("1.gz", whole.substr(0, 100'000))),
                    second = test::contents(zipped("2.gz", whole.substr(100'000)));
  EXPECT_TRUE(is_the_same_streamed(folder.write("members.nii.gz", first + second + std::string(100, '\0'))));
  EXPECT_TRUE(scratch.names().empty());
}

TEST_F(StreamedVolumes, OfVectorsHaveOneNumberOfEachOrTheirLengths) {
  const std::string header =
      "NRRD0004\ntype: short\ndimension: 4\nkinds: vector domain domain domain\nsizes: 3 70 65 130\n"
      "endian: big\nencoding: gzip\n\n";
  const auto file = folder.write("v.nrrd", header + test::contents(zipped("samples", noise(samples * 6))));
  EXPECT_TRUE(is_the_same_streamed(file));
  EXPECT_TRUE(is_the_same_streamed(file, "samples:1"));
}

TEST_F(StreamedVolumes, ThatComeInOneOrderOnlyStayInMemory) {
  std::string header = test::nifti_header();
  const std::int16_t dim[] = {5, nx, ny, nz, 1, 3, 1, 1};  // each component contiguous
  std::memcpy(header.data() + 40, dim, sizeof dim);
  const auto file = zipped("planes.nii.gz", header + noise(samples * 6));
  const VolumeFile volume = open_volume(file, streaming());
  EXPECT_TRUE(volume.in_memory);
  EXPECT_EQ(volume.scratch, nullptr);
}

TEST_F(StreamedVolumes, ThatAreDamagedAreRefusedInOneLine) {
  const std::string zipped_whole = test::contents(zipped("a.nii.gz", nifti_of(2, 1)));
  const auto refused = [&](const std::string& name, const std::string& content) {
    const auto file = folder.write(name, content);
    SCOPED_TRACE(name + " of " + std::to_string(content.size()));
    test::expect_bad_input([&] { open_volume(file, streaming()); }, {name + ": ", "again"});
    EXPECT_TRUE(scratch.names().empty());
  };
  for (const std::size_t left : {std::size_t{400}, zipped_whole.size() / 2, zipped_whole.size() - 500})
    refused("cut.nii.gz", zipped_whole.substr(0, left));
}

TEST_F(StreamedVolumes, GoIntoAFileIfTheyAreLargeAndThereIsRoom) {
  const auto file = zipped("a.nii.gz", nifti_of(2, 1));
  ReadOptions options;
  options.memory_bytes = 2 * samples;
  EXPECT_EQ(open_volume(file, options).scratch, nullptr);
  options.memory_bytes = 2 * (samples - 1);
  EXPECT_NE(open_volume(file, options).scratch, nullptr);
  const test::ScratchFolder nowhere(scratch / "nowhere");
  EXPECT_TRUE(open_volume(file, options).in_memory);
  test::expect_bad_input([&] { open_unscanned_volume(file, options, true); }, {"a.nii.gz: its samples", "set TMPDIR"});
}

TEST_F(StreamedVolumes, AreWrittenInAnyPartsThatTheyComeIn) {
  StreamedSamples streamed;
  streamed.grid.geometry.points = {nx, ny, nz};
  streamed.grid.type = scene::SampleType::uint8;
  streamed.choice.type = scene::SampleType::uint8;
  const std::string bytes = noise(samples);
  std::vector<double> expected;
  for (const std::size_t part : {std::size_t{1000}, std::size_t{nx} * ny, std::size_t{12'345}, samples}) {
    streamed.tuples = [&](const system::ByteSink& use) {
      for (std::size_t at = 0; at < bytes.size(); at += part)
        use(std::as_bytes(std::span(bytes).subspan(at, std::min(part, bytes.size() - at))));
    };
    const auto file = scratch_bricks(streamed, "v");
    const VolumeFile back = open_bricks(file->path(), {}, "v");
    const std::vector<double> read = all_samples(*back.source);
    if (expected.empty()) expected = read;
    EXPECT_EQ(read, expected) << part;
    EXPECT_EQ(scene::value_range(*back.source), value_range(streamed));
  }
  for (std::size_t k = 0; k < samples; ++k) ASSERT_EQ(expected[k], static_cast<double>(bytes[k]));
}

}  // namespace
}  // namespace tessera::io
