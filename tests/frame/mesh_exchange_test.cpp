// SPDX-License-Identifier: BSD-3-Clause
#include "frame/ranks/mesh_exchange.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <map>
#include <random>

#include "datasets/boxes.hpp"
#include "exchange/loopback_transport.hpp"
#include "frame/ranks/mesh_chunk.hpp"
#include "scene/error.hpp"

namespace tessera::frame::mesh_exchange_test {
namespace {

using exchange::Bytes;
using exchange::Channel;
using exchange::Transport;
using projection::Partition;
using projection::PartitionKind;

/// Distribution of the tets before the exchange.
enum class Start { first_rank, last_rank, slices, in_turns };

/// The part of `rank` of a mesh distributed in this way: with unused vertices, and its own vertex numbers.
MeshPart part_of(const scene::TetMesh& mesh, Start start, int rank, int ranks, unsigned seed) {
  std::mt19937 random(seed);
  MeshPart part;
  part.mesh.association = mesh.association;
  part.mesh.field_name = mesh.field_name;
  std::vector<std::uint32_t> number(mesh.positions.size());
  const std::uint32_t shift = static_cast<std::uint32_t>(rank) % 2 ? 17 : 0;
  for (std::size_t v = 0; v < number.size(); ++v)
    number[v] = static_cast<std::uint32_t>((v + shift) % mesh.positions.size());
  part.mesh.positions.resize(mesh.positions.size());
  for (std::size_t v = 0; v < number.size(); ++v) part.mesh.positions[number[v]] = mesh.positions[v];
  if (mesh.association == scene::Association::point) {
    part.mesh.scalars.resize(mesh.scalars.size());
    for (std::size_t v = 0; v < number.size(); ++v) part.mesh.scalars[number[v]] = mesh.scalars[v];
  }
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
    const int owner = start == Start::first_rank  ? 0
                      : start == Start::last_rank ? ranks - 1
                      : start == Start::slices    ? projection::part_in_file_order(t, mesh.tets.size(), ranks)
                                                  : static_cast<int>(random() % static_cast<unsigned>(ranks));
    if (owner != rank) continue;
    const scene::Tet& tet = mesh.tets[t];
    part.mesh.tets.push_back({number[tet[0]], number[tet[1]], number[tet[2]], number[tet[3]]});
    part.global_tet.push_back(t);
    if (mesh.association == scene::Association::cell) part.mesh.scalars.push_back(mesh.scalars[t]);
  }
  if (part.mesh.tets.empty()) part = {};  // like a rank that has read nothing
  return part;
}

/// A tet as bits that do not depend on vertex numbers: positions and scalars in the order of its corners.
std::vector<double> content(const scene::TetMesh& mesh, std::size_t t) {
  std::vector<double> values;
  for (const std::uint32_t v : mesh.tets[t]) {
    for (int k = 0; k < 3; ++k) values.push_back(mesh.positions[v][k]);
    if (mesh.association == scene::Association::point) values.push_back(mesh.scalars[v]);
  }
  if (mesh.association == scene::Association::cell) values.push_back(mesh.scalars[t]);
  return values;
}

bool same_bits(const std::vector<double>& a, const std::vector<double>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(double)) == 0;
}

struct Result {
  std::vector<MeshPart> parts;  ///< one per rank
  std::vector<scene::MeshFacts> facts;
};

Result exchange(const scene::TetMesh& mesh, Start start, int ranks, const std::vector<int>& projectors,
                const Partition& how, const ExchangeLimits& limits, unsigned seed = 1) {
  Result result;
  result.parts.resize(static_cast<std::size_t>(ranks));
  result.facts.resize(static_cast<std::size_t>(ranks));
  exchange::run_ranks(ranks, [&](Transport& transport) {
    const auto r = static_cast<std::size_t>(transport.rank());
    MeshPart part = part_of(mesh, start, transport.rank(), ranks, seed);
    result.facts[r] = agree_facts(transport, part.mesh);
    result.parts[r] = redistribute(transport, std::move(part), result.facts[r], how, projectors, limits);
  });
  return result;
}

/// Every tet is on exactly one projector, with its bits, in ascending order, without unused vertices.
void expect_whole(const Result& result, const scene::TetMesh& mesh, const std::vector<int>& projectors) {
  std::vector<int> seen(mesh.tets.size(), 0);
  for (std::size_t r = 0; r < result.parts.size(); ++r) {
    const MeshPart& part = result.parts[r];
    const bool projects = std::find(projectors.begin(), projectors.end(), static_cast<int>(r)) != projectors.end();
    if (!projects) {
      EXPECT_TRUE(part.mesh.tets.empty());
    }
    EXPECT_TRUE(std::is_sorted(part.global_tet.begin(), part.global_tet.end()));
    EXPECT_NO_THROW(scene::validate(part.mesh, "part"));
    for (std::size_t t = 0; t < part.mesh.tets.size(); ++t) {
      const std::uint64_t whole = part.global_of(t);
      ASSERT_LT(whole, mesh.tets.size());
      ++seen[whole];
      ASSERT_TRUE(same_bits(content(part.mesh, t), content(mesh, whole))) << "tet " << whole << " on rank " << r;
    }
  }
  EXPECT_TRUE(std::all_of(seen.begin(), seen.end(), [](int n) { return n == 1; }));
}

const ExchangeLimits small{2000, 5000};  // limits in bytes: small meshes need many messages and rounds

TEST(MeshExchange, EveryTetReachesItsOneOwnerWithItsBits) {
  scene::TetMesh mesh = datasets::cube(5);
  for (int k = 0; k < 40; ++k) mesh.positions[static_cast<std::size_t>(3 * k)].y *= 1 + 1e-15;  // not float numbers
  scene::TetMesh cells = mesh;
  cells.association = scene::Association::cell;
  cells.scalars.clear();
  for (std::size_t t = 0; t < cells.tets.size(); ++t) cells.scalars.push_back(std::sqrt(static_cast<double>(t)));
  for (const scene::TetMesh* m : {&mesh, &cells})
    for (const PartitionKind kind : {PartitionKind::file, PartitionKind::curve, PartitionKind::random})
      for (const Start start : {Start::first_rank, Start::last_rank, Start::slices, Start::in_turns})
        for (const auto& [ranks, projectors] :
             {std::pair<int, std::vector<int>>{1, {0}}, {2, {1}}, {3, {0, 1, 2}}, {5, {4, 1, 2}}, {8, {0, 7}}}) {
          SCOPED_TRACE(testing::Message() << "kind " << static_cast<int>(kind) << " start " << static_cast<int>(start)
                                          << " ranks " << ranks << " projectors " << projectors.size());
          const Result result = exchange(*m, start, ranks, projectors, {kind, 3}, small);
          expect_whole(result, *m, projectors);
          for (const auto& facts : result.facts) EXPECT_EQ(facts, scene::facts_of(*m));
        }
}

TEST(MeshExchange, PartsDependOnTheMeshAndNotOnItsReaders) {
  const scene::TetMesh mesh = datasets::cube(6);
  for (const PartitionKind kind : {PartitionKind::file, PartitionKind::curve, PartitionKind::random}) {
    const auto reference = exchange(mesh, Start::first_rank, 4, {0, 2, 3}, {kind, 9}, {});
    for (const Start start : {Start::last_rank, Start::slices, Start::in_turns}) {
      const auto other = exchange(mesh, start, 4, {0, 2, 3}, {kind, 9}, small, 5);
      for (std::size_t r = 0; r < 4; ++r) EXPECT_EQ(other.parts[r].global_tet, reference.parts[r].global_tet);
    }
    // With one reader, the numbering of vertices does not depend on how the mesh is cut into messages.
    const auto chunked = exchange(mesh, Start::first_rank, 4, {0, 2, 3}, {kind, 9}, small);
    for (std::size_t r = 0; r < 4; ++r) {
      EXPECT_EQ(chunked.parts[r].mesh.tets, reference.parts[r].mesh.tets);
      EXPECT_EQ(chunked.parts[r].mesh.positions, reference.parts[r].mesh.positions);
    }
  }
}

TEST(MeshExchange, VerticesAreCompact) {
  const scene::TetMesh mesh = datasets::cube(8);
  const auto result = exchange(mesh, Start::first_rank, 3, {0, 1, 2}, {PartitionKind::curve, 1}, small);
  for (const MeshPart& part : result.parts) {
    std::vector<bool> used(part.mesh.positions.size());
    for (const scene::Tet& tet : part.mesh.tets)
      for (const std::uint32_t v : tet) used[v] = true;
    EXPECT_EQ(std::count(used.begin(), used.end(), false), 0);
    std::vector<std::array<double, 3>> places;
    for (const glm::dvec3& p : part.mesh.positions) places.push_back({p.x, p.y, p.z});
    std::sort(places.begin(), places.end());
    EXPECT_EQ(std::adjacent_find(places.begin(), places.end()), places.end());  // each once, over all messages
  }
}

TEST(MeshExchange, PartsAreBalanced) {
  const scene::TetMesh mesh = datasets::cube(20);
  for (const PartitionKind kind : {PartitionKind::file, PartitionKind::curve}) {
    const auto result = exchange(mesh, Start::slices, 5, {0, 1, 2, 3, 4}, {kind, 1}, {});
    for (const MeshPart& part : result.parts)
      EXPECT_NEAR(static_cast<double>(part.mesh.tets.size()), mesh.tets.size() / 5.0, 0.01 * mesh.tets.size() / 5.0);
  }
}

TEST(MeshExchange, NothingIsSentWhereEverythingIsInPlace) {
  const scene::TetMesh mesh = datasets::cube(4);
  exchange::run_ranks(3, [&](Transport& transport) {
    MeshPart part = part_of(mesh, Start::slices, transport.rank(), 3, 1);
    const scene::MeshFacts facts = agree_facts(transport, part.mesh);
    const glm::dvec3* before = part.mesh.positions.data();
    const std::vector<int> projectors = {0, 1, 2};
    part = redistribute(transport, std::move(part), facts, {PartitionKind::file, 1}, projectors);
    EXPECT_EQ(part.mesh.positions.data(), before);
    EXPECT_EQ(transport.sent(Channel::mesh).messages, 0u);
  });
}

TEST(MeshExchange, NoMessageIsMuchLargerThanAsked) {
  const scene::TetMesh mesh = datasets::cube(10);
  exchange::run_ranks(3, [&](Transport& transport) {
    MeshPart part = part_of(mesh, Start::first_rank, transport.rank(), 3, 1);
    const scene::MeshFacts facts = agree_facts(transport, part.mesh);
    const std::vector<int> projectors = {1, 2};
    redistribute(transport, std::move(part), facts, {}, projectors, small);
    if (transport.rank() != 0) return;
    const auto sent = transport.sent(Channel::mesh);
    EXPECT_GE(sent.messages, sent.bytes / (small.chunk_bytes + 200));  // a message may exceed the limit by one tet
  });
}

TEST(MeshExchange, AMeshWithoutTetsAndOneTetWork) {
  scene::TetMesh one = datasets::cube(1);
  one.tets.resize(1);
  scene::TetMesh none = one;
  none.tets.clear();
  for (const PartitionKind kind : {PartitionKind::file, PartitionKind::curve, PartitionKind::random})
    for (const scene::TetMesh* m : {&one, &none})
      expect_whole(exchange(*m, Start::last_rank, 3, {0, 1}, {kind, 1}, small), *m, {0, 1});
}

TEST(MeshExchange, AFaultOfOneRankReachesAll) {
  const scene::TetMesh mesh = datasets::cube(4);
  try {
    exchange::run_ranks(3, [&](Transport& transport) {
      if (transport.rank() == 1) throw scene::bad_input("piece_1.vtu: it is truncated; write the file again");
      MeshPart part = part_of(mesh, Start::slices, transport.rank(), 3, 1);
      agree_facts(transport, part.mesh);
    });
    FAIL() << "no error";
  } catch (const scene::Error& error) {
    EXPECT_STREQ(error.what(), "piece_1.vtu: it is truncated; write the file again");
  }
}

TEST(MeshChunk, MalformedMessagesAreRefused) {
  const scene::TetMesh mesh = datasets::cube(1);
  MeshPart whole{mesh, {}};
  ChunkSender sender(whole, std::vector<std::uint32_t>(6, 0), 1, 0, 1 << 20);
  int part = -1;
  Bytes message;
  ASSERT_TRUE(sender.next(part, message));
  EXPECT_EQ(part, 0);
  const auto refused = [&](const Bytes& bytes) {
    ChunkReceiver receiver(scene::facts_of(mesh), 6, 1);
    try {
      receiver.add(0, bytes);
      receiver.finish();
      return false;
    } catch (const scene::Error&) {
      return true;
    }
  };
  EXPECT_FALSE(refused(message));
  for (const std::size_t size : {std::size_t{0}, std::size_t{31}, message.size() - 1})
    EXPECT_TRUE(refused(Bytes(message.begin(), message.begin() + static_cast<std::ptrdiff_t>(size)))) << size;
  for (const std::size_t at : {0, 4, 6, 8, 12, 16, 24}) {  // each value of the headers
    Bytes changed = message;
    changed[at] ^= std::byte{1};
    EXPECT_TRUE(refused(changed)) << at;
  }
  Bytes changed = message;
  changed.back() = std::byte{0x7f};  // a corner
  EXPECT_TRUE(refused(changed));
  EXPECT_FALSE(sender.next(part, message));
}

}  // namespace
}  // namespace tessera::frame::mesh_exchange_test
