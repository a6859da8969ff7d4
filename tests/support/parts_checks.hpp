// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <gtest/gtest.h>

#include <cstring>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "cells/block_choice.hpp"
#include "cells/duplicate_cells.hpp"
#include "io/mesh/mesh_parts.hpp"
#include "support/read_files.hpp"

/// Compares meshes that are read in parts with the same meshes read at once.
namespace tessera::io::testing {

/// Positions and scalars of the tets in order, as bits.
inline std::vector<double> content(const scene::TetMesh& mesh) {
  std::vector<double> values;
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
    for (const std::uint32_t v : mesh.tets[t]) {
      for (int k = 0; k < 3; ++k) values.push_back(mesh.positions[v][k]);
      if (mesh.association == scene::Association::point) values.push_back(mesh.scalars[v]);
    }
    if (mesh.association == scene::Association::cell) values.push_back(mesh.scalars[t]);
  }
  return values;
}

struct InParts {
  std::vector<MeshFilePart> parts;
  cells::MeshFile whole;  ///< its mesh empty
};

inline InParts read_in_parts(const std::filesystem::path& file, int parts, const ReadOptions& options = {}) {
  std::vector<std::unique_ptr<MeshPartReading>> readings;
  std::vector<std::vector<cells::FieldTally>> tallies;
  std::vector<std::string> names;
  for (int p = 0; p < parts; ++p) {
    readings.push_back(std::make_unique<MeshPartReading>(identify(file), options, p, parts));
    tallies.push_back(readings.back()->tallies());
    cells::add_notes(readings.back()->block_names(), names);
  }
  scene::Box box = cells::higher_order_box({});
  for (const auto& reading : readings) box = cells::joined(box, reading->box());
  cells::ExcessTally excess{};
  for (const auto& reading : readings) {
    reading->choose(tallies, box, names);
    const cells::ExcessTally own = reading->excess();
    for (std::size_t bin = 0; bin < own.size(); ++bin) excess[bin] += own[bin];
  }
  InParts result;
  std::vector<PartSummary> summaries;
  std::vector<std::uint64_t> keys;
  for (auto& reading : readings) {
    result.parts.push_back(reading->finish(excess));
    summaries.push_back(result.parts.back().summary);
    keys.insert(keys.end(), result.parts.back().cell_keys.begin(), result.parts.back().cell_keys.end());
  }
  summaries.front().counts.cells_duplicate = cells::count_repetitions(keys);
  result.whole = io::joined(result.parts.back(), summaries, file);
  return result;
}

inline void expect_as_whole(const std::filesystem::path& file, const ReadOptions& options = {}) {
  ASSERT_TRUE(readable_in_parts(identify(file), options));
  const cells::MeshFile whole = read_mesh(file, options);
  for (const int parts : {1, 2, 3, 7}) {
    SCOPED_TRACE(::testing::Message() << file << " in " << parts << " parts");
    const InParts read = read_in_parts(file, parts, options);
    std::vector<double> together;
    for (const MeshFilePart& part : read.parts) {
      EXPECT_EQ(part.mesh.association, whole.mesh.association);
      EXPECT_EQ(part.mesh.field_name, whole.mesh.field_name);
      const std::vector<double> own = content(part.mesh);
      together.insert(together.end(), own.begin(), own.end());
    }
    const std::vector<double> expected = content(whole.mesh);
    ASSERT_EQ(together.size(), expected.size());
    EXPECT_EQ(std::memcmp(together.data(), expected.data(), expected.size() * sizeof(double)), 0);
    EXPECT_EQ(read.whole.counts, whole.counts);
    EXPECT_EQ(read.whole.fields, whole.fields);
    EXPECT_EQ(read.whole.notes, whole.notes);
    EXPECT_EQ(read.whole.format, whole.format);
    EXPECT_EQ(read.whole.blocks, whole.blocks);
    EXPECT_EQ(read.whole.surfaces, whole.surfaces);
    EXPECT_EQ(read.whole.mesh.field_name, whole.mesh.field_name);
    EXPECT_EQ(read.whole.mesh.association, whole.mesh.association);
  }
}

}  // namespace tessera::io::testing
