// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <gtest/gtest.h>
#include <zlib.h>

#include <algorithm>
#include <bit>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "support/read_files.hpp"
#include "support/scratch_folder.hpp"
#include "support/temporary_folder.hpp"

namespace tessera::test {

inline std::vector<std::uint64_t> bits_of(const scene::GridGeometry& g) {
  std::vector<std::uint64_t> bits;
  const auto add = [&](double x) { bits.push_back(std::bit_cast<std::uint64_t>(x)); };
  for (int k = 0; k < 3; ++k) {
    add(g.origin[k]), add(g.spacing[k]);
    for (int row = 0; row < 3; ++row) add(g.direction[k][row]);
    for (const double x : g.coordinates[static_cast<std::size_t>(k)]) add(x);
  }
  return bits;
}

/// Lengths of vectors are rounded to floats where they are stored; all other samples here are floats or shorter, or
/// integers.
inline std::vector<float> floats_of(const scene::SampleSource& source) {
  std::vector<float> values(static_cast<std::size_t>(source.geometry().all_samples().count()));
  source.read(source.geometry().all_samples(), std::span<float>(values));
  return values;
}

/// Tests of volumes that are unpacked into a file in a separate directory.
class StreamedVolumes : public ::testing::Test {
 protected:
  [[nodiscard]] std::filesystem::path zipped(const std::string& name, const std::string& content) const {
    std::filesystem::path file = folder / name;
    gzFile out = gzopen(file.c_str(), "wb");
    EXPECT_EQ(gzwrite(out, content.data(), static_cast<unsigned>(content.size())), static_cast<int>(content.size()));
    gzclose(out);
    return file;
  }
  static ReadOptions streaming(const std::string& field = "") {
    ReadOptions options;
    options.field = field;
    options.memory_bytes = 1;
    return options;
  }
  /// Samples and description of `file` must be the same whether unpacked into memory or into a file; returns whether it
  /// was unpacked into a file.
  static bool is_the_same_streamed(const std::filesystem::path& file, const std::string& field = "") {
    const io::VolumeFile whole = io::open_volume(file, {.field = field}),
                         parts = io::open_volume(file, streaming(field));
    EXPECT_EQ(whole.scratch, nullptr);
    EXPECT_EQ(floats_of(*whole.source), floats_of(*parts.source)) << file;
    EXPECT_EQ(whole.source->geometry(), parts.source->geometry()) << file;
    EXPECT_EQ(bits_of(whole.source->geometry()), bits_of(parts.source->geometry())) << file;
    EXPECT_EQ(whole.source->grid().type, parts.source->grid().type);
    EXPECT_EQ(whole.source->grid().scale, parts.source->grid().scale);
    EXPECT_EQ(whole.source->grid().field_name, parts.source->grid().field_name);
    EXPECT_EQ(whole.range, parts.range) << file;
    EXPECT_EQ(whole.notes, parts.notes);
    EXPECT_EQ(whole.format, parts.format);
    EXPECT_EQ(whole.fields.size(), parts.fields.size());
    for (std::size_t k = 0; k < std::min(whole.fields.size(), parts.fields.size()); ++k) {
      const cells::FieldSummary &a = whole.fields[k], &b = parts.fields[k];
      EXPECT_EQ(a.name, b.name);
      EXPECT_EQ(a.association, b.association);
      EXPECT_EQ(a.components, b.components);
      EXPECT_EQ(a.type, b.type);
      if (a.components == 1) {
        EXPECT_EQ(a.low, b.low) << file;
        EXPECT_EQ(a.high, b.high) << file;
      } else {  // rounded to floats, as lengths are stored
        EXPECT_EQ(static_cast<float>(a.low), static_cast<float>(b.low)) << file;
        EXPECT_EQ(static_cast<float>(a.high), static_cast<float>(b.high)) << file;
      }
      EXPECT_EQ(a.nan_count, b.nan_count);
      EXPECT_EQ(a.active, b.active) << file;
    }
    EXPECT_EQ(parts.in_memory, false) << file;
    return parts.scratch != nullptr;
  }

  const TemporaryFolder folder, scratch;
  const ScratchFolder scratch_folder{scratch.path()};
};

}  // namespace tessera::test
