// SPDX-License-Identifier: BSD-3-Clause
#include "frame/ranks/mesh_exchange.hpp"

#include <algorithm>
#include <array>
#include <numeric>

#include "exchange/collectives.hpp"
#include "frame/ranks/mesh_chunk.hpp"
#include "frame/ranks/reduce.hpp"

namespace tessera::frame {
namespace {

using exchange::append;
using exchange::append_list;
using exchange::begin_message;
using exchange::Bytes;
using exchange::Channel;
using exchange::MessageKind;
using exchange::Transport;
using projection::PartitionKind;

/// Returns every rank's row, one rank after the other. All rows must have the length of this rank's row.
std::vector<std::uint64_t> gather_rows(Transport& transport, const std::vector<std::uint64_t>& row) {
  Bytes mine = begin_message(MessageKind::tet_table);
  append_list(mine, row);
  std::vector<std::uint64_t> table;
  int from = 0;
  for (const Bytes& bytes : gather_all(transport, std::move(mine))) {
    exchange::MessageReader reader(bytes, from++, MessageKind::tet_table);
    if (reader.take<std::uint64_t>() != row.size()) reader.refuse("is of another number of projectors");
    reader.take_onto(table, row.size());
    reader.finish();
  }
  return table;
}

/// Writes the values to a message field by field, because the structure has padding.
Bytes message_of(const scene::MeshFacts& facts) {
  Bytes message = begin_message(MessageKind::mesh_facts);
  append(message, facts.box.low);
  append(message, facts.box.high);
  append(message, facts.scalar_range);
  append(message, facts.tets);
  append(message, static_cast<std::uint8_t>(facts.association));
  return message;
}

scene::MeshFacts facts_in(const Bytes& message, int from) {
  exchange::MessageReader reader(message, from, MessageKind::mesh_facts);
  scene::MeshFacts facts;
  facts.box.low = reader.take<glm::dvec3>();
  facts.box.high = reader.take<glm::dvec3>();
  facts.scalar_range = reader.take<std::array<double, 2>>();
  facts.tets = reader.take<std::uint64_t>();
  facts.association = reader.take<std::uint8_t>() == 0 ? scene::Association::point : scene::Association::cell;
  reader.finish();
  return facts;
}

/// Does the same as projection::parts_of_whole, for a mesh that is distributed over ranks.
std::vector<std::uint32_t> parts_of_tets(Transport& transport, const MeshPart& local, const scene::MeshFacts& facts,
                                         const projection::Partition& how, int parts) {
  std::vector<std::uint32_t> part_of(local.mesh.tets.size());
  const auto fill = [&](const auto& part) {
    for (std::size_t t = 0; t < part_of.size(); ++t) part_of[t] = static_cast<std::uint32_t>(part(t));
  };
  switch (how.kind) {
    case PartitionKind::file:
      fill([&](std::size_t t) { return projection::part_in_file_order(local.global_of(t), facts.tets, parts); });
      break;
    case PartitionKind::random:
      fill([&](std::size_t t) { return projection::part_at_random(local.global_of(t), how.seed, parts); });
      break;
    case PartitionKind::curve: {
      const auto keys = projection::curve_keys(local.mesh, local.global_tet, facts.box);
      projection::CurveCut cut(facts.tets, parts);
      while (!cut.done()) cut.narrow(reduce_all(transport, cut.count(keys), Reduction::sum));
      fill([&](std::size_t t) { return projection::part_on_curve(keys[t], cut.splitters()); });
      break;
    }
  }
  return part_of;
}

}  // namespace

scene::MeshFacts agree_facts(Transport& transport, const scene::TetMeshView& part) {
  if (transport.size() == 1) return scene::facts_of(part);
  scene::MeshFacts own{scene::bounds(part), scene::scalar_range(part), 0, part.tets.size(), part.association}, facts;
  int from = 0;
  for (const Bytes& other : gather_all(transport, message_of(own))) facts = joined(facts, facts_in(other, from++));
  scene::VolumeSum volume = 0;
  for (const auto other : gather_values(transport, MessageKind::mesh_volume, volume_sum(part, facts.box)))
    volume += other;
  facts.mean_thickness = scene::mean_thickness(facts.box, volume);
  return facts;
}

std::vector<std::uint64_t> numbered_by_rank(Transport& transport, std::size_t tets) {
  std::uint64_t first = 0;
  const std::vector<std::uint64_t> counts = gather_values(transport, MessageKind::tet_count, std::uint64_t{tets});
  for (int rank = 0; rank < transport.rank(); ++rank) first += counts[static_cast<std::size_t>(rank)];
  std::vector<std::uint64_t> numbers(tets);
  std::iota(numbers.begin(), numbers.end(), first);
  return numbers;
}

MeshPart redistribute(Transport& transport, MeshPart local, const scene::MeshFacts& facts,
                      const projection::Partition& how, std::span<const int> projectors, const ExchangeLimits& limits) {
  if (transport.size() == 1) return local;
  const int parts = static_cast<int>(projectors.size()), self = transport.rank();
  std::vector<std::uint32_t> part_of = parts_of_tets(transport, local, facts, how, parts);

  std::vector<std::uint64_t> row(projectors.size(), 0);
  for (const std::uint32_t p : part_of) ++row[p];
  // Element r parts + p: tets from rank r for part p.
  const std::vector<std::uint64_t> table = gather_rows(transport, row);
  std::uint64_t coming = 0;
  bool moves = false;
  for (std::size_t k = 0; k < table.size(); ++k) {
    const int from = static_cast<int>(k) / parts, to = projectors[k % projectors.size()];
    if (to == self) coming += table[k];
    moves = moves || (from != to && table[k] > 0);
  }
  if (!moves) return local;

  ChunkReceiver receiver(facts, coming, transport.size());
  const auto own = std::find(projectors.begin(), projectors.end(), self);
  // Each rank begins with a different part, so that not all send to the same rank.
  const int first_part = own == projectors.end() ? self % parts : static_cast<int>(own - projectors.begin());
  ChunkSender sender(local, std::move(part_of), parts, first_part, limits.chunk_bytes);
  for (bool all_sent = false; !all_sent;) {
    // A round consists of some messages, then the numbers of all ranks' messages. No rank gets past the exchange of
    // numbers before all ranks have received the previous round.
    std::vector<std::uint64_t> sent(projectors.size() + 1,
                                    0);  // messages for each part; the last element: whether more will follow
    std::size_t bytes = 0;
    int part = 0;
    Bytes message;
    sent.back() = 1;
    while (bytes < limits.round_bytes) {
      if (!sender.next(part, message)) {
        sent.back() = 0;
        break;
      }
      const int to = projectors[static_cast<std::size_t>(part)];
      if (to == self) {
        receiver.add(self, message);
        continue;
      }
      bytes += message.size();
      ++sent[static_cast<std::size_t>(part)];
      transport.send(to, Channel::mesh, std::move(message));
    }
    const std::vector<std::uint64_t> all = gather_rows(transport, sent);
    std::uint64_t awaited = 0;
    all_sent = true;
    for (std::size_t k = 0; k < all.size(); ++k) {
      const std::size_t column = k % sent.size();
      if (column == projectors.size())
        all_sent = all_sent && all[k] == 0;
      else if (projectors[column] == self)
        awaited += all[k];
    }
    for (; awaited > 0; --awaited) {
      const exchange::Message taken = transport.receive(Channel::mesh);
      receiver.add(taken.from, taken.bytes);
    }
  }
  const std::string field_name = std::move(local.mesh.field_name);
  local = {};
  MeshPart result = receiver.finish();
  result.mesh.field_name = field_name;
  return result;
}

}  // namespace tessera::frame
