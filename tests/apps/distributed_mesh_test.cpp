// SPDX-License-Identifier: BSD-3-Clause
#include "frame/ranks/distributed_mesh.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>

#include "apps/program.hpp"
#include "datasets/boxes.hpp"
#include "datasets/modify.hpp"
#include "exchange/loopback_transport.hpp"
#include "io/mesh/mesh_parts.hpp"
#include "scene/error.hpp"
#include "support/foam_case.hpp"
#include "support/read_files.hpp"

namespace tessera::apps {
namespace {

using exchange::Transport;
using frame::DistributedMesh;
using frame::read_distributed;
using projection::PartitionKind;

/// A tet's positions and scalars in the order of its corners.
std::vector<double> content(const scene::TetMesh& mesh, std::size_t t) {
  std::vector<double> values;
  for (const std::uint32_t v : mesh.tets[t]) {
    for (int k = 0; k < 3; ++k) values.push_back(mesh.positions[v][k]);
    if (mesh.association == scene::Association::point) values.push_back(mesh.scalars[v]);
  }
  if (mesh.association == scene::Association::cell) values.push_back(mesh.scalars[t]);
  return values;
}

std::vector<DistributedMesh> read_on(int ranks, const std::filesystem::path& file, const std::vector<int>& projectors,
                                     PartitionKind kind, const ReadOptions& options = {}) {
  std::vector<DistributedMesh> result(static_cast<std::size_t>(ranks));
  exchange::run_ranks(ranks, [&](Transport& transport) {
    result[static_cast<std::size_t>(transport.rank())] =
        read_distributed(transport, std::span(&file, 1), io::identify(file), options, {kind, 1}, projectors);
  });
  return result;
}

void expect_as_read_mesh(const std::filesystem::path& file, const ReadOptions& options = {}) {
  const cells::MeshFile whole = io::read_mesh(file, options);
  const scene::MeshFacts facts = scene::facts_of(whole.mesh);
  for (const PartitionKind kind : {PartitionKind::file, PartitionKind::curve, PartitionKind::random})
    for (const auto& [ranks, projectors] :
         {std::pair<int, std::vector<int>>{1, {0}}, {2, {0}}, {3, {1, 2}}, {4, {0, 1, 2, 3}}, {5, {3, 0, 4}}}) {
      SCOPED_TRACE(::testing::Message() << file << ", " << projectors.size() << " projectors of " << ranks
                                        << " ranks, partition " << static_cast<int>(kind));
      std::vector<int> seen(whole.mesh.tets.size(), 0);
      for (const DistributedMesh& rank : read_on(ranks, file, projectors, kind, options)) {
        EXPECT_EQ(rank.facts, facts);
        EXPECT_EQ(rank.description.counts, whole.counts);
        EXPECT_EQ(rank.description.notes, whole.notes);
        EXPECT_EQ(rank.description.format, whole.format);
        EXPECT_EQ(rank.description.fields.size(), whole.fields.size());
        EXPECT_EQ(rank.description.mesh.field_name, whole.mesh.field_name);
        EXPECT_TRUE(rank.description.mesh.tets.empty());
        EXPECT_EQ(rank.part.mesh.field_name, whole.mesh.field_name);
        EXPECT_EQ(rank.part.mesh.association, whole.mesh.association);
        for (std::size_t t = 0; t < rank.part.mesh.tets.size(); ++t) {
          const std::uint64_t id = rank.part.global_of(t);
          ASSERT_LT(id, seen.size());
          ++seen[id];
          ASSERT_EQ(content(rank.part.mesh, t), content(whole.mesh, id));
        }
      }
      EXPECT_EQ(std::count(seen.begin(), seen.end(), 1), static_cast<std::ptrdiff_t>(seen.size()));
    }
}

std::string write_pieces(const Folder& folder, const std::vector<scene::TetMesh>& pieces) {
  std::string list = "<VTKFile type=\"PUnstructuredGrid\"><PUnstructuredGrid>";
  for (std::size_t p = 0; p < pieces.size(); ++p) {
    io::write_vtu(pieces[p], folder / fmt::format("piece{}.vtu", p));
    list += fmt::format("<Piece Source=\"piece{}.vtu\"/>", p);
  }
  return folder.file("m.pvtu", list + "</PUnstructuredGrid></VTKFile>");
}

TEST(DistributedMesh, IsWhatOneProcessReads) {
  const Folder folder;
  scene::TetMesh mesh = datasets::cube(4);
  mesh.scalars[20] = std::numeric_limits<double>::quiet_NaN();
  io::write_tets(mesh, folder / "m.tets");
  expect_as_read_mesh(folder / "m.tets");
  io::write_vtu(mesh, folder / "m.vtu");
  expect_as_read_mesh(folder / "m.vtu");  // a format that is not read in parts

  std::vector<scene::TetMesh> pieces(5);
  for (std::size_t p = 0; p < pieces.size(); ++p) {
    pieces[p] = mesh;
    pieces[p].tets.clear();
    for (std::size_t t = p; t < mesh.tets.size(); t += p == 4 ? mesh.tets.size() : 4)
      if (p < 4) pieces[p].tets.push_back(mesh.tets[t]);
  }
  expect_as_read_mesh(write_pieces(folder, pieces));
}

TEST(DistributedMesh, ItsTraceCountsTheTetsThatMove) {
  const Folder folder;
  const std::filesystem::path file = folder / "m.vtu";  // one process reads it, so nothing is sent before
  io::write_vtu(datasets::cube(4), file);
  const std::vector<int> projectors = {0, 1};
  exchange::run_ranks(2, [&](Transport& transport) {
    Trace trace;
    ReadOptions options;
    options.trace = &trace;
    read_distributed(transport, std::span(&file, 1), io::identify(file), options, {PartitionKind::random, 1},
                     projectors);
    const auto sent = transport.sent(exchange::Channel::mesh);
    const std::vector<TraceSpan> spans = trace.spans();
    const auto found = std::ranges::find(spans, std::string_view("partition"), &TraceSpan::stage);
    ASSERT_NE(found, spans.end());
    EXPECT_EQ(sent.bytes > 0, transport.rank() == 0);
    EXPECT_EQ(found->bytes, sent.bytes);
    EXPECT_EQ(found->messages, sent.messages);
  });
}

TEST(DistributedMesh, ADecomposedCaseIsReadByItsProcessors) {
  const Folder folder;
  const io::testing::Cubes cubes(4);
  const std::filesystem::path place = folder / "case";
  for (int part = 0; part < 4; ++part)
    io::testing::write_foam(place / fmt::format("processor{}", part), cubes, [&](int c) { return c / 16 == part; });
  io::testing::write_control(place);
  ReadOptions options;
  options.time_step = 0;
  expect_as_read_mesh(place / "case.foam", options);
  options.smooth = true;
  expect_as_read_mesh(place / "case.foam", options);
}

TEST(DistributedMesh, CellDataAndSmoothingAreAsInOneProcess) {
  const Folder folder;
  scene::TetMesh mesh = datasets::cube(3);
  mesh.association = scene::Association::cell;
  mesh.scalars.clear();
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) mesh.scalars.push_back(0.1 * static_cast<double>(t % 17));
  const std::string file = write_pieces(folder, {mesh, datasets::cube(1)});
  ReadOptions options;
  EXPECT_THROW(io::read_mesh(file, options), scene::Error);  // the second piece has another field
  const std::string same = write_pieces(folder, {mesh, mesh});
  expect_as_read_mesh(same);
  options.smooth = true;
  expect_as_read_mesh(same, options);
}

TEST(DistributedMesh, DuplicatesAreCountedAcrossProcesses) {
  const Folder folder;
  const scene::TetMesh mesh = datasets::cube(3);
  scene::TetMesh corner = mesh;
  corner.tets.resize(17);
  const std::string file = write_pieces(folder, {mesh, corner, datasets::cube(2), corner});
  EXPECT_GE(io::read_mesh(file, {}).counts.cells_duplicate, 34u);
  expect_as_read_mesh(file);
  ReadOptions options;
  options.drop_duplicates = true;
  expect_as_read_mesh(file, options);
}

TEST(DistributedMesh, AFaultInOnePieceIsTheErrorOfAll) {
  const Folder folder;
  const std::string file = write_pieces(folder, {datasets::cube(2), datasets::cube(2), datasets::cube(2)});
  std::filesystem::resize_file(folder / "piece2.vtu", 700);
  try {
    read_on(3, file, {0, 1, 2}, PartitionKind::curve);
    FAIL() << "no error";
  } catch (const scene::Error& error) {
    EXPECT_EQ(error.code(), scene::ErrorCode::bad_input);
    EXPECT_NE(std::string(error.what()).find("piece2.vtu: "), std::string::npos) << error.what();
  }
  for (const char* name : {"none.pvtu", "none.vtu", "none.tets"})
    EXPECT_THROW(read_on(2, folder / name, {0, 1}, PartitionKind::curve), scene::Error);
}

}  // namespace
}  // namespace tessera::apps
