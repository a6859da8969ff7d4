// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "exchange/message.hpp"
#include "frame/ranks/mesh_exchange.hpp"

/// The wire record of channel `mesh`, with its sender and its receiver.
namespace tessera::frame {

/// The header of a message `mesh_chunk`, after its MessageHeader. It is followed by (v = vertices, t = tets):
///
///     f64 xyz[3 v]
///     f64 scalar[v] of point data, scalar[t] of cell data
///     u64 global_tet[t]
///     u32 tets[4 t]
///
/// Vertices are numbered along the stream from one rank to another. A message contains v new vertices, numbered from
/// `first_vertex` on; its tets refer to these and to earlier vertices.
struct MeshChunkHeader {
  std::uint32_t association = 0;  ///< scene::Association
  std::uint32_t vertices = 0, tets = 0;
  std::uint32_t reserved = 0;
  std::uint64_t first_vertex = 0;
};
static_assert(sizeof(MeshChunkHeader) == 24);

/// Cuts a rank's tets into messages, one part after the other, starting with part `first_part`.
class ChunkSender {
 public:
  /// `part_of[t]` is the part of tet t. `local` must outlive the sender.
  ChunkSender(const MeshPart& local, std::vector<std::uint32_t> part_of, int parts, int first_part,
              std::size_t chunk_bytes);

  /// Returns the next message, and in `part` the part to which it belongs; false when all messages have been sent.
  bool next(int& part, exchange::Bytes& message);

 private:
  void begin_part();

  const MeshPart& local_;
  std::size_t chunk_bytes_;
  int parts_, first_part_, turn_ = -1;  ///< the `turn_`th part is being sent
  std::vector<std::uint64_t> begin_;    ///< begin of each part in `order_`; parts + 1 values
  std::vector<std::uint32_t> order_;    ///< tets sorted by part, ascending within each part
  std::size_t at_ = 0, end_ = 0;        ///< range in `order_` of the tets of the current part that are not sent yet
  /// Number of each vertex in the stream; `unsent` if the vertex was not sent to this part.
  std::vector<std::uint32_t> number_;
  std::uint64_t sent_vertices_ = 0;
};

/// Combines the messages of all ranks.
class ChunkReceiver {
 public:
  ChunkReceiver(const scene::MeshFacts& facts, std::uint64_t tets, int ranks);

  /// Throws Error(system_failure) if the message does not match its MeshChunkHeader.
  void add(int from, const exchange::Bytes& message);

  /// Returns the part, in canonical order, independent of the order in which messages arrived.
  MeshPart finish();

 private:
  struct Base {
    std::uint64_t first;  ///< number of a vertex in the stream
    std::uint64_t own;    ///< index of the same vertex in `part_`
  };

  scene::Association association_;
  std::uint64_t expected_;
  MeshPart part_;
  std::vector<std::vector<Base>> bases_;   ///< one list per rank, with an entry for each of its messages
  std::vector<std::uint64_t> stream_end_;  ///< number of vertices received from each rank
};

}  // namespace tessera::frame
