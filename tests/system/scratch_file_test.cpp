// SPDX-License-Identifier: BSD-3-Clause
// Samples in files: in place, or in a scratch file that others read too.
#include "system/scratch_file.hpp"

#include <gtest/gtest.h>
#include <sys/resource.h>

#include <algorithm>
#include <atomic>
#include <cstring>
#include <random>

#include "io/volume/brick_file.hpp"
#include "io/volume/file_source.hpp"
#include "support/scratch_folder.hpp"
#include "support/temporary_folder.hpp"

namespace tessera::io {
namespace {

using test::expect_bad_input;
using test::fault_of;
using test::ScratchFolder;

std::vector<std::byte> random_bytes(std::size_t count) {
  std::mt19937 random(5);
  std::vector<std::byte> bytes(count);
  for (std::byte& b : bytes) b = static_cast<std::byte>(random());
  return bytes;
}

std::filesystem::path write(const test::TemporaryFolder& folder, std::span<const std::byte> bytes) {
  return folder.write("samples", {reinterpret_cast<const char*>(bytes.data()), bytes.size()});
}

scene::Grid grid_of(const scene::GridIndex& points, scene::SampleType type) {
  scene::Grid grid;
  grid.geometry.points = points;
  grid.type = type;
  return grid;
}

TEST(FileSources, ReadWhatMemoryWouldGive) {
  struct Case {
    scene::GridIndex points;
    scene::SampleType type;
    int components, component;
    bool swapped;
    scene::SampleType as;
  };
  using scene::SampleType;
  // Short rows that are read together, rows far apart, whole rows, rows longer than a read; magnitudes, swapped bytes.
  const Case cases[] = {{{20, 9, 7}, SampleType::uint8, 1, 0, false, SampleType::uint8},
                        {{20, 9, 7}, SampleType::int16, 1, 0, true, SampleType::float32},
                        {{20, 9, 7}, SampleType::int16, 3, 1, true, SampleType::int16},
                        {{20, 9, 7}, SampleType::uint8, 3, -1, false, SampleType::float32},
                        {{5000, 4, 3}, SampleType::uint8, 1, 0, false, SampleType::float64},
                        {{40000, 3, 2}, SampleType::int32, 1, 0, true, SampleType::float32},
                        {{40000, 3, 2}, SampleType::int32, 1, 0, false, SampleType::int32}};
  const test::TemporaryFolder folder;
  for (const Case& c : cases) {
    const auto count = static_cast<std::size_t>(c.points[0] * c.points[1] * c.points[2] * c.components);
    const std::size_t before = 13;
    const std::vector<std::byte> bytes = random_bytes(before + count * scene::size_of(c.type));
    const auto file = write(folder, bytes);
    const scene::Grid grid = grid_of(c.points, c.component < 0 ? SampleType::float32 : c.type);
    const scene::ComponentChoice choice{c.components, c.component, c.type};
    const scene::MemorySource memory(grid, std::span(bytes).subspan(before), nullptr, "memory", choice, c.swapped);
    const FileSource source(grid, file, before, file.string(), choice, c.swapped);
    const scene::GridIndex n = grid.geometry.samples();
    const scene::SampleBox boxes[] = {
        {{0, 0, 0}, n}, {{3, 1, 1}, {17, 3, 2}}, {{0, 1, 0}, {n[0], 3, 2}}, {{2, 2, 1}, n}};
    for (const scene::SampleBox& box : boxes) {
      // Contiguous, and with gaps between rows and slices.
      for (const std::int64_t more : {0, 5}) {
        const scene::SampleLayout layout{c.as, box.extent(0) + more, (box.extent(0) + more) * box.extent(1) + more};
        const auto room = static_cast<std::size_t>(layout.slice_pitch * box.extent(2)) * scene::size_of(c.as);
        std::vector<std::byte> expected(room), read(room);
        memory.read(box, layout, expected);
        source.read(box, layout, read);
        EXPECT_TRUE(expected == read) << c.points[0] << " wide, " << c.components << " components, pitch " << more;
      }
    }
    EXPECT_GT(source.bytes_read(), 0u);
  }
}

TEST(FileSources, ReportsAFileThatIsShortenedWhileRead) {
  const test::TemporaryFolder folder;
  const auto file = write(folder, random_bytes(1000));
  const FileSource source(grid_of({10, 10, 10}, scene::SampleType::uint8), file, 0, "big.raw",
                          {.type = scene::SampleType::uint8}, false);
  std::filesystem::resize_file(file, 500);
  std::vector<float> values(1000);
  const auto fault = fault_of([&] { source.read({{0, 0, 0}, {10, 10, 10}}, std::span(values)); });
  EXPECT_EQ(fault.code, scene::ErrorCode::system_failure);
  EXPECT_NE(fault.message.find("big.raw: it has been shortened to 500 bytes"), std::string::npos) << fault.message;
}

TEST(ScratchFiles, AreUnnamedAndReadableAfterTheirWriterEnds) {
  const test::TemporaryFolder folder;
  const ScratchFolder scratch(folder.path());
  auto file = std::make_unique<system::ScratchFile>("v.nii.gz", 5);
  file->write("12345");
  EXPECT_EQ(file->folder(), folder.path());
  EXPECT_TRUE(folder.names().empty());
  const system::PositionalFile reader(file->path());
  file.reset();
  std::string text(5, ' ');
  reader.read(0, reinterpret_cast<std::byte*>(text.data()), 5);
  EXPECT_EQ(text, "12345");
  EXPECT_TRUE(folder.names().empty());
}

TEST(ScratchFiles, ReportsAMissingDirectoryWithARemedy) {
  const test::TemporaryFolder folder;
  const ScratchFolder scratch(folder / "nowhere");
  expect_bad_input([] { system::ScratchFile("v.nii.gz", 5); },
                   {"v.nii.gz: its samples", (folder / "nowhere").string(), "No such file", "set TMPDIR"});
}

TEST(ScratchFiles, ReportsAFullDiskBeforeWriting) {
  const test::TemporaryFolder folder;
  const ScratchFolder scratch(folder.path());
  rlimit before{};
  ASSERT_EQ(::getrlimit(RLIMIT_FSIZE, &before), 0);
  const rlimit small{1 << 20, before.rlim_max};
  ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &small), 0);
  expect_bad_input([] { system::ScratchFile("v.nii.gz", 3'200'000'000); },
                   {"v.nii.gz", "3.2 GB", "free some space there"});
  EXPECT_NO_THROW(system::ScratchFile("v.nii.gz", 1 << 20));
  ::setrlimit(RLIMIT_FSIZE, &before);
  EXPECT_TRUE(folder.names().empty());
}

/// Counts the samples read.
class CountedSource final : public scene::SampleSource {
 public:
  CountedSource(const scene::Grid& grid, std::vector<float> values)
      : SampleSource(grid, "counted"), whole_(scene::MemorySource::of(grid, std::move(values))) {}
  [[nodiscard]] std::int64_t samples_read() const { return read_; }

 private:
  void read_samples(const scene::SampleBox& box, const scene::SampleLayout& layout, std::byte* to) const override {
    read_ += box.count();
    whole_->read(box, layout, {to, static_cast<std::size_t>(box.count()) * scene::size_of(layout.type)});
  }
  std::unique_ptr<scene::MemorySource> whole_;
  mutable std::atomic<std::int64_t> read_ = 0;
};

TEST(ScratchBricks, AreTheSamplesAndTheirRangeReadOnce) {
  const test::TemporaryFolder folder;
  const ScratchFolder scratch(folder.path());
  scene::Grid grid = grid_of({150, 70, 66}, scene::SampleType::float32);
  grid.scale = -0.25, grid.shift = 1.0 / 3;
  grid.geometry.coordinates[0].resize(150);
  for (std::size_t i = 0; i < 150; ++i) grid.geometry.coordinates[0][i] = 0.1 * static_cast<double>(i * i);
  for (std::size_t a : {1, 2}) {
    grid.geometry.coordinates[a].resize(static_cast<std::size_t>(grid.geometry.points[a]));
    for (std::size_t i = 0; i < grid.geometry.coordinates[a].size(); ++i)
      grid.geometry.coordinates[a][i] = static_cast<double>(i) / 3;
  }
  grid.field_name = "velocity:0";
  std::mt19937 random(7);
  std::vector<float> values(150 * 70 * 66);
  for (float& v : values) v = random() % 50 == 0 ? NAN : static_cast<float>(random()) * 0x1p-31f - 1;
  const auto file = [&] {
    const CountedSource source(grid, values);
    auto written = scratch_bricks(source, "v.vtr");
    EXPECT_EQ(source.samples_read(), 150 * 70 * 66);
    return written;
  }();
  EXPECT_EQ(std::filesystem::file_size(file->path()), file->bytes());
  const VolumeFile back = open_bricks(file->path(), {}, "v.vtr");
  EXPECT_EQ(back.source->grid().geometry, grid.geometry);
  EXPECT_EQ(back.source->grid().scale, grid.scale);
  EXPECT_EQ(back.source->grid().shift, grid.shift);
  EXPECT_EQ(back.source->grid().field_name, "velocity:0");
  std::vector<float> read(values.size());
  back.source->read(grid.geometry.all_samples(), std::span(read));
  EXPECT_EQ(std::memcmp(read.data(), values.data(), values.size() * sizeof(float)), 0);
  const auto memory = scene::MemorySource::of(grid, values);
  EXPECT_EQ(scene::value_range(*back.source), scene::value_range(*memory));
}

}  // namespace
}  // namespace tessera::io
