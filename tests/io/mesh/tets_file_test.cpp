// SPDX-License-Identifier: BSD-3-Clause
#include "io/mesh/tets_file.hpp"

#include <gtest/gtest.h>

#include <cstring>

#include "cells/mesh_assembly.hpp"
#include "support/mesh_checks.hpp"
#include "support/read_files.hpp"
#include "support/vtk_or_skip.hpp"

namespace tessera::io {
namespace {

using test::expect_bad_input;

/// g++ 12 drops the rounding of `x = static_cast<float>(x)` when it vectorizes a loop of them; volatile keeps it.
double rounded(double x) {
  const volatile float f = static_cast<float>(x);
  return f;
}

scene::TetMesh small() {
  scene::TetMesh mesh = cells::assemble_mesh({testing::mixed_mesh(2, 4, false)}, {}, "mesh").mesh;
  for (glm::dvec3& p : mesh.positions) p = {rounded(p.x), rounded(p.y), rounded(p.z)};
  for (double& s : mesh.scalars) s = rounded(s);
  return mesh;
}

TEST(TetsFile, RoundTripsBitForBit) {
  const test::TemporaryFolder folder;
  const scene::TetMesh mesh = small();
  write_tets(mesh, folder / "m.tets");
  const cells::MeshFile read = read_mesh(folder / "m.tets");
  EXPECT_EQ(read.mesh.positions, mesh.positions);
  EXPECT_EQ(read.mesh.tets, mesh.tets);
  EXPECT_EQ(read.mesh.scalars, mesh.scalars);
  EXPECT_EQ(std::filesystem::file_size(folder / "m.tets"), 16 + 16 * (mesh.positions.size() + mesh.tets.size()));
  EXPECT_EQ(folder.names(), std::vector<std::string>{"m.tets"});
}

TEST(TetsFile, CellDataAndNumbersPastFloatAreRefused) {
  const test::TemporaryFolder folder;
  scene::TetMesh mesh = small();
  mesh.positions[0].x = 1e300;
  expect_bad_input([&] { write_tets(mesh, folder / "m.tets"); }, {"m.tets: 1e+300 does not fit"});
  mesh.association = scene::Association::cell;
  mesh.scalars.assign(mesh.tets.size(), 1);
  expect_bad_input([&] { write_tets(mesh, folder / "m.tets"); }, {"point data only"});
  EXPECT_TRUE(folder.names().empty());
}

std::vector<std::byte> bytes(std::int64_t nverts, std::int64_t ntets, std::size_t body) {
  std::vector<std::byte> all(16 + body, std::byte{0});
  std::memcpy(all.data(), &nverts, 8);
  std::memcpy(all.data() + 8, &ntets, 8);
  return all;
}

TEST(TetsFile, SizesAreCheckedBeforeAnythingIsAllocated) {
  const auto parse = [](std::vector<std::byte> b) { return [b] { parse_tets(TetsBytes(b), "m.tets"); }; };
  expect_bad_input(parse({}), {"m.tets: 0 bytes are too few"});
  expect_bad_input(parse(bytes(-1, 1, 100)), {"its header states -1 vertices"});
  expect_bad_input(parse(bytes(1, -1, 100)), {"and -1 tets"});
  expect_bad_input(parse(bytes(INT64_MAX, INT64_MAX, 100)), {"its header states"});
  expect_bad_input(parse(bytes(4, INT64_MAX / 16, 80)), {"its header states"});
  expect_bad_input(parse(bytes(1'000'000'000, 1'000'000'000, 100)), {"truncated"});
  expect_bad_input(parse(bytes(4, 1, 79)), {"truncated"});
  expect_bad_input(parse(bytes(4, 1, 81)), {"another format"});
  EXPECT_EQ(parse_tets(TetsBytes(bytes(4, 1, 80)), "m").tets.size(), 1u);
}

TEST(TetsFile, IndicesAreChecked) {
  for (const std::int32_t wrong : {-1, 4, INT32_MAX, INT32_MIN}) {
    std::vector<std::byte> all = bytes(4, 2, 96);
    std::memcpy(all.data() + 16 + 64 + 16 + 8, &wrong, 4);
    expect_bad_input([&] { parse_tets(TetsBytes(all), "m.tets"); },
                     {"tet 1 uses vertex", "but the file has only 4 vertices"});
  }
}

TEST(TetsFile, NaNBlanksTheTetsThatUseIt) {
  const test::TemporaryFolder folder;
  scene::TetMesh mesh = small();
  mesh.scalars[mesh.tets[0][0]] = NAN;
  write_tets(mesh, folder / "m.tets");
  const cells::MeshFile read = read_mesh(folder / "m.tets");
  EXPECT_GT(read.counts.cells_nan, 0u);
  EXPECT_EQ(read.counts.cells_nan + read.mesh.tets.size(), mesh.tets.size());
  EXPECT_EQ(read.mesh.original_cell.size(), read.mesh.tets.size());
}

TEST(VtuWriter, RoundTripsBitForBit) {
  TESSERA_VTK_OR_SKIP();
  const test::TemporaryFolder folder;
  scene::TetMesh mesh = cells::assemble_mesh({testing::mixed_mesh(2, 4, false)}, {}, "mesh").mesh;
  write_vtu(mesh, folder / "m.vtu");
  cells::MeshFile read = read_mesh(folder / "m.vtu");
  EXPECT_EQ(read.mesh.positions, mesh.positions);
  EXPECT_EQ(read.mesh.tets, mesh.tets);
  EXPECT_EQ(read.mesh.scalars, mesh.scalars);
  EXPECT_EQ(read.mesh.field_name, "f");

  mesh.association = scene::Association::cell;
  mesh.scalars.clear();
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) mesh.scalars.push_back(1.0 / static_cast<double>(t + 1));
  write_vtu(mesh, folder / "m.vtu");
  read = read_mesh(folder / "m.vtu");
  EXPECT_EQ(read.mesh.association, scene::Association::cell);
  EXPECT_EQ(read.mesh.scalars, mesh.scalars);
  EXPECT_EQ(folder.names(), std::vector<std::string>{"m.vtu"});
}

TEST(VtuWriter, ReportsAMissingDirectoryAndLeavesNothing) {
  const test::TemporaryFolder folder;
  EXPECT_NE(testing::message_of([&] { write_vtu(small(), folder / "none" / "m.vtu"); }), "");
  EXPECT_NE(testing::message_of([&] { write_tets(small(), folder / "none" / "m.tets"); }), "");
  EXPECT_TRUE(folder.names().empty());
}

}  // namespace
}  // namespace tessera::io
