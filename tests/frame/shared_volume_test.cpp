// SPDX-License-Identifier: BSD-3-Clause
// Volumes that several ranks read as a whole.
#include "frame/grid/shared_volume.hpp"

#include <gtest/gtest.h>
#include <zlib.h>

#include <cstdlib>
#include <cstring>
#include <mutex>
#include <set>
#include <string>
#include <vector>

#include "exchange/loopback_transport.hpp"
#include "frame/grid/brick_memory.hpp"
#include "scene/error.hpp"
#include "support/read_files.hpp"
#include "support/temporary_folder.hpp"
#include "support/volume_bytes.hpp"

namespace tessera::frame::shared_volume_test {
namespace {

/// Files in one directory, temporary ones in another.
class SharedVolume : public ::testing::Test {
 protected:
  SharedVolume() { ::setenv("TMPDIR", scratch_.path().c_str(), 1); }
  ~SharedVolume() override { before_.empty() ? ::unsetenv("TMPDIR") : ::setenv("TMPDIR", before_.c_str(), 1); }

  [[nodiscard]] std::filesystem::path zipped(const std::string& name, const std::string& content) const {
    const std::filesystem::path file = folder_ / name;
    gzFile out = gzopen(file.c_str(), "wb");
    EXPECT_EQ(gzwrite(out, content.data(), static_cast<unsigned>(content.size())), static_cast<int>(content.size()));
    gzclose(out);
    return file;
  }

  /// The volume opened by every one of `ranks` ranks.
  [[nodiscard]] static std::vector<io::VolumeFile> opened(const std::filesystem::path& file, int ranks,
                                                          ReadOptions options = {}) {
    options.threads = 1;
    std::mutex mutex;
    std::vector<io::VolumeFile> all(static_cast<std::size_t>(ranks));
    exchange::run_ranks(ranks, [&](exchange::Transport& transport) {
      io::VolumeFile volume = open_shared_volume(transport, io::identify(file), options);
      const std::lock_guard lock(mutex);
      all[static_cast<std::size_t>(transport.rank())] = std::move(volume);
    });
    return all;
  }

  /// The error that ends the run, thrown on every rank.
  [[nodiscard]] static test::Fault fault(const std::filesystem::path& file, int ranks) {
    std::mutex mutex;
    std::multiset<std::string> messages;
    const test::Fault ended = test::fault_of([&] {
      exchange::run_ranks(ranks, [&](exchange::Transport& transport) {
        try {
          static_cast<void>(open_shared_volume(transport, io::identify(file), {}));
        } catch (const scene::Error& error) {
          const std::lock_guard lock(mutex);
          messages.insert(error.what());
          throw;
        }
      });
    });
    EXPECT_EQ(messages.count(ended.message), static_cast<std::size_t>(ranks)) << ended.message;
    return ended;
  }

  const std::string before_ = std::getenv("TMPDIR") == nullptr ? "" : std::getenv("TMPDIR");
  const test::TemporaryFolder folder_, scratch_;
};

std::vector<double> samples_of(const scene::SampleSource& source) {
  const scene::SampleBox all = source.geometry().all_samples();
  std::vector<double> values(static_cast<std::size_t>(all.count()));
  source.read(all, std::span(values));
  return values;
}

TEST_F(SharedVolume, IsKeptOnceWithTheDescriptionOfOneProcess) {
  std::string header = test::nifti_header();
  test::put<float>(header, 112, 2.5f);  // slope
  const auto file = zipped("v.nii.gz", header + test::bytes_of(test::counting<std::int16_t>(24)));
  const io::VolumeFile alone = io::open_unscanned_volume(file);
  EXPECT_TRUE(alone.in_memory);
  for (const int ranks : {1, 2, 3}) {
    for (const io::VolumeFile& volume : opened(file, ranks)) {
      EXPECT_EQ(samples_of(*volume.source), samples_of(*alone.source));
      EXPECT_EQ(volume.source->geometry(), alone.source->geometry());
      EXPECT_EQ(volume.source->grid().scale, 2.5);
      EXPECT_EQ(volume.source->grid().type, alone.source->grid().type);
      EXPECT_EQ(volume.source->grid().field_name, alone.source->grid().field_name);
      EXPECT_EQ(volume.format, alone.format);
      EXPECT_EQ(volume.body_axes, alone.body_axes);
      ASSERT_EQ(volume.fields.size(), 1u);
      EXPECT_EQ(volume.fields[0].name, alone.fields[0].name);
      EXPECT_EQ(volume.fields[0].type, alone.fields[0].type);
      // Samples in memory are not read from a file.
      EXPECT_EQ(volume.source->bytes_read() > 0, ranks > 1) << ranks;
      ASSERT_EQ(volume.notes.size(), alone.notes.size() + (ranks > 1 ? 1 : 0));
      if (ranks == 1) continue;
      const std::string& note = volume.notes.back();
      for (const std::string& part : {std::string("v.nii.gz is read as a whole"), scratch_.path().string(),
                                      std::to_string(ranks) + " ranks", std::string(" kB")})
        EXPECT_NE(note.find(part), std::string::npos) << note;
    }
    EXPECT_TRUE(scratch_.names().empty());
  }
}

TEST_F(SharedVolume, ByOneProcessIsOnDiskIfMemoryMayNotHoldIt) {
  const auto file = zipped("v.nii.gz", test::nifti());
  ReadOptions options;
  options.memory_bytes = 2 * 47;  // the samples are 24 numbers of two bytes
  const io::VolumeFile alone = io::open_unscanned_volume(file);
  const std::vector<io::VolumeFile> by_one = opened(file, 1, options);
  const io::VolumeFile& kept = by_one[0];
  EXPECT_EQ(samples_of(*kept.source), samples_of(*alone.source));
  EXPECT_GT(kept.source->bytes_read(), 0u);
  ASSERT_EQ(kept.notes.size(), alone.notes.size() + 1);
  for (const std::string& part : {std::string("v.nii.gz is read as a whole: its samples are kept on disk"),
                                  scratch_.path().string(), std::string("is removed when the run ends")})
    EXPECT_NE(kept.notes.back().find(part), std::string::npos) << kept.notes.back();
  EXPECT_TRUE(scratch_.names().empty());
  options.memory_bytes = 2 * 48;
  EXPECT_EQ(opened(file, 1, options)[0].notes.size(), alone.notes.size());
}

TEST_F(SharedVolume, OfAVectorHasTheComponentThatIsAskedForAndItsFieldsRange) {
  const std::string nrrd =
      "NRRD0004\ntype: short\ndimension: 4\nkinds: vector domain domain domain\nsizes: 2 4 3 2\n"
      "endian: little\nencoding: gzip\n\n";
  const std::string samples = test::bytes_of(test::counting<std::int16_t>(48));
  const auto packed = test::contents(zipped("samples", samples));
  const auto file = folder_.write("v.nrrd", nrrd + packed);
  ReadOptions options;
  options.field = "samples:1";
  const io::VolumeFile alone = io::open_unscanned_volume(file, options);
  for (const io::VolumeFile& volume : opened(file, 3, options)) {
    EXPECT_EQ(samples_of(*volume.source), samples_of(*alone.source));
    EXPECT_EQ(volume.source->grid().field_name, alone.source->grid().field_name);
    EXPECT_EQ(volume.fields[0].components, 2);
    EXPECT_EQ(volume.fields[0].low, alone.fields[0].low);
    EXPECT_EQ(volume.fields[0].high, alone.fields[0].high);
  }
}

TEST_F(SharedVolume, ThatIsReadInPlaceIsReadWhereItIs) {
  const auto file = folder_.write("v.nii", test::nifti());
  for (const io::VolumeFile& volume : opened(file, 3)) {
    EXPECT_FALSE(volume.in_memory);
    EXPECT_TRUE(volume.notes.empty());
    EXPECT_EQ(samples_of(*volume.source).size(), 24u);
  }
}

TEST_F(SharedVolume, ThatIsDamagedEndsTheRunForAllWithOneError) {
  const auto file = zipped("v.nii.gz", test::nifti().substr(0, 360));
  const test::Fault ended = fault(file, 3);
  EXPECT_EQ(ended.code, scene::ErrorCode::bad_input);
  EXPECT_NE(ended.message.find("v.nii.gz"), std::string::npos);
  EXPECT_TRUE(scratch_.names().empty());
}

TEST_F(SharedVolume, WithoutRoomForItEndsTheRunForAllWithARemedy) {
  const auto file = zipped("v.nii.gz", test::nifti());
  ::setenv("TMPDIR", (scratch_ / "nowhere").c_str(), 1);
  const test::Fault ended = fault(file, 3);
  EXPECT_EQ(ended.code, scene::ErrorCode::bad_input);
  for (const std::string part : {"v.nii.gz", "nowhere", "set TMPDIR to another directory"})
    EXPECT_NE(ended.message.find(part), std::string::npos) << ended.message;
  // A single process needs no directory for temporary files.
  EXPECT_EQ(opened(file, 1).size(), 1u);
}

TEST(BrickMemory, IsTheBudgetMinusOtherMemory) {
  constexpr std::uint64_t mib = 1 << 20, brick = 33 * 33 * 33;
  const OtherMemory rest{200 * mib, 30 * mib, {512, 512}, 1};
  const std::uint64_t left = brick_memory(1024 * mib, rest, brick);
  // Two copies of the image (10 MiB), a thread and the heap are subtracted, and a hundredth for the overhead of the
  // bricks.
  EXPECT_LT(left, (1024 - 200 - 30 - 10) * mib);
  EXPECT_GT(left, (1024 - 200 - 30 - 10 - 20) * mib * 99 / 100);
  EXPECT_EQ(brick_memory(64 * mib, rest, brick), 8 * mib);
  EXPECT_EQ(brick_memory(mib, rest, brick), mib);
  // Small bricks have a larger overhead.
  EXPECT_LT(brick_memory(1024 * mib, rest, 729), left * 9 / 10);
}

}  // namespace
}  // namespace tessera::frame::shared_volume_test
