// SPDX-License-Identifier: BSD-3-Clause
#include "frame/ranks/mesh_chunk.hpp"

#include <fmt/format.h>
#include <tbb/parallel_sort.h>

#include <algorithm>
#include <limits>
#include <numeric>

namespace tessera::frame {
namespace {

using exchange::append;
using exchange::append_values;

constexpr std::uint32_t unsent = std::numeric_limits<std::uint32_t>::max();
constexpr std::uint64_t most_indices = unsent;

}  // namespace

ChunkSender::ChunkSender(const MeshPart& local, std::vector<std::uint32_t> part_of, int parts, int first_part,
                         std::size_t chunk_bytes)
    : local_(local),
      chunk_bytes_(chunk_bytes),
      parts_(parts),
      first_part_(first_part),
      begin_(static_cast<std::size_t>(parts) + 1, 0),
      order_(part_of.size()),
      number_(local.mesh.positions.size(), unsent) {
  for (const std::uint32_t p : part_of) ++begin_[p + 1];
  std::partial_sum(begin_.begin(), begin_.end(), begin_.begin());
  std::vector<std::uint64_t> next(begin_.begin(), begin_.end() - 1);
  for (std::size_t t = 0; t < part_of.size(); ++t) order_[next[part_of[t]]++] = static_cast<std::uint32_t>(t);
}

void ChunkSender::begin_part() {
  if (turn_ >= 0)  // resets only the numbers that were used: a reset of all for each of many parts would take too long
    for (std::size_t k = begin_[static_cast<std::size_t>((first_part_ + turn_) % parts_)]; k < end_; ++k)
      for (const std::uint32_t v : local_.mesh.tets[order_[k]]) number_[v] = unsent;
  ++turn_;
  const auto part = static_cast<std::size_t>((first_part_ + turn_) % parts_);
  at_ = begin_[part];
  end_ = begin_[part + 1];
  sent_vertices_ = 0;
}

bool ChunkSender::next(int& part, exchange::Bytes& message) {
  while (at_ == end_) {
    if (turn_ + 1 == parts_) return false;
    begin_part();
  }
  part = (first_part_ + turn_) % parts_;
  const scene::TetMesh& mesh = local_.mesh;
  const bool point = mesh.association == scene::Association::point;
  MeshChunkHeader header;
  header.association = static_cast<std::uint32_t>(mesh.association);
  header.first_vertex = sent_vertices_;
  std::vector<glm::dvec3> positions;
  std::vector<double> scalars;
  std::vector<std::uint64_t> global_tet;
  std::vector<scene::Tet> tets;
  std::size_t size = sizeof header;
  for (; at_ < end_ && (tets.empty() || size < chunk_bytes_); ++at_) {
    const std::size_t t = order_[at_];
    scene::Tet tet = mesh.tets[t];
    for (std::uint32_t& v : tet) {
      if (number_[v] == unsent) {
        number_[v] = static_cast<std::uint32_t>(sent_vertices_++);
        positions.push_back(mesh.positions[v]);
        if (point) scalars.push_back(mesh.scalars[v]);
        size += sizeof(glm::dvec3) + (point ? sizeof(double) : 0);
      }
      v = number_[v];
    }
    tets.push_back(tet);
    global_tet.push_back(local_.global_of(t));
    if (!point) scalars.push_back(mesh.scalars[t]);
    size += sizeof(scene::Tet) + sizeof(std::uint64_t) + (point ? 0 : sizeof(double));
  }
  header.vertices = static_cast<std::uint32_t>(positions.size());
  header.tets = static_cast<std::uint32_t>(tets.size());
  message = exchange::begin_message(exchange::MessageKind::mesh_chunk, size);
  append(message, header);
  append_values(message, positions);
  append_values(message, scalars);
  append_values(message, global_tet);
  append_values(message, tets);
  return true;
}

ChunkReceiver::ChunkReceiver(const scene::MeshFacts& facts, std::uint64_t tets, int ranks)
    : association_(facts.association),
      expected_(tets),
      bases_(static_cast<std::size_t>(ranks)),
      stream_end_(static_cast<std::size_t>(ranks), 0) {
  if (tets > most_indices)
    throw scene::Error(
        scene::ErrorCode::system_failure,
        fmt::format("one process would receive {} tets, but supports at most 2^32 - 1; use more processes", tets));
  part_.mesh.association = association_;
  part_.mesh.tets.reserve(tets);
  part_.global_tet.reserve(tets);
  if (association_ == scene::Association::cell) part_.mesh.scalars.reserve(tets);
}

void ChunkReceiver::add(int from, const exchange::Bytes& message) {
  const auto refuse = [&](const std::string& what) {
    return scene::Error(scene::ErrorCode::system_failure,
                        fmt::format("a part of the mesh from rank {}: {}; please report", from, what));
  };
  exchange::MessageReader reader(message, from, exchange::MessageKind::mesh_chunk);
  const auto header = reader.take<MeshChunkHeader>();
  const bool point = association_ == scene::Association::point;
  const std::uint64_t v = header.vertices, t = header.tets;
  if (header.association != static_cast<std::uint32_t>(association_))
    reader.refuse("brings tets of another association");
  std::vector<Base>& bases = bases_[static_cast<std::size_t>(from)];
  std::uint64_t& stream_end = stream_end_[static_cast<std::size_t>(from)];
  if (header.first_vertex != stream_end)
    throw refuse(fmt::format("it begins at vertex {}, but {} vertices came before", header.first_vertex, stream_end));
  scene::TetMesh& mesh = part_.mesh;
  const std::uint64_t known = mesh.positions.size(), first_tet = mesh.tets.size();
  if (known + v > most_indices)
    throw scene::Error(
        scene::ErrorCode::system_failure,
        "one process would receive more than 2^32 - 1 vertices, which it does not support; use more processes");
  bases.push_back({header.first_vertex, known});
  reader.take_onto(mesh.positions, v);
  reader.take_onto(mesh.scalars, point ? v : t);
  reader.take_onto(part_.global_tet, t);
  reader.take_onto(mesh.tets, t);
  reader.finish();
  stream_end += v;
  for (std::size_t k = first_tet; k < mesh.tets.size(); ++k)
    for (std::uint32_t& i : mesh.tets[k]) {
      if (i >= stream_end) throw refuse(fmt::format("vertex {} of {}", i, stream_end));
      const auto base = i >= header.first_vertex
                            ? bases.end() - 1
                            : std::upper_bound(bases.begin(), bases.end(), std::uint64_t{i},
                                               [](std::uint64_t n, const Base& b) { return n < b.first; }) -
                                  1;
      i = static_cast<std::uint32_t>(base->own + (i - base->first));
    }
}

MeshPart ChunkReceiver::finish() {
  scene::TetMesh& mesh = part_.mesh;
  const std::size_t n = mesh.tets.size();
  if (n != expected_)
    throw scene::Error(
        scene::ErrorCode::system_failure,
        fmt::format("{} tets of a mesh were expected, but {} were received; please report this", expected_, n));
  if (!std::is_sorted(part_.global_tet.begin(), part_.global_tet.end())) {
    std::vector<std::uint32_t> order(n);
    std::iota(order.begin(), order.end(), 0u);
    tbb::parallel_sort(order.begin(), order.end(),
                       [&](std::uint32_t a, std::uint32_t b) { return part_.global_tet[a] < part_.global_tet[b]; });
    const auto reorder = [&](auto& values) {
      std::remove_reference_t<decltype(values)> sorted(n);
      for (std::size_t k = 0; k < n; ++k) sorted[k] = values[order[k]];
      values = std::move(sorted);
    };
    reorder(mesh.tets);
    reorder(part_.global_tet);
    if (association_ == scene::Association::cell) reorder(mesh.scalars);
  }
  // Vertices are in the order of first use, which is compact in memory and independent of the order of messages.
  std::vector<std::uint32_t> number(mesh.positions.size(), unsent), old;
  old.reserve(mesh.positions.size());
  for (scene::Tet& tet : mesh.tets)
    for (std::uint32_t& v : tet) {
      if (number[v] == unsent) {
        number[v] = static_cast<std::uint32_t>(old.size());
        old.push_back(v);
      }
      v = number[v];
    }
  const auto gather = [&](auto& values) {
    std::remove_reference_t<decltype(values)> gathered(old.size());
    for (std::size_t k = 0; k < old.size(); ++k) gathered[k] = values[old[k]];
    values = std::move(gathered);
  };
  gather(mesh.positions);
  if (association_ == scene::Association::point) gather(mesh.scalars);
  return std::move(part_);
}

}  // namespace tessera::frame
