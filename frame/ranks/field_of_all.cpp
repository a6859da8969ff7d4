// SPDX-License-Identifier: BSD-3-Clause
#include "frame/ranks/field_of_all.hpp"

#include <algorithm>
#include <utility>

#include "exchange/collectives.hpp"

namespace tessera::frame {

using exchange::MessageKind;

std::optional<scene::FillValue> find_fill_value(exchange::Transport& transport, const scene::TetMeshView& part,
                                                const scene::MeshFacts& facts) {
  const auto [low, high] = facts.scalar_range;
  if (!scene::may_be_fill(low) && !scene::may_be_fill(high)) return std::nullopt;
  scene::FillTally own, whole;
  for (const double value : part.scalars) own.add(value);
  for (const scene::FillTally& each : exchange::gather_values(transport, MessageKind::fill_tally, own)) whole.add(each);
  return whole.found();
}

scene::FieldSamples gather_field_samples(exchange::Transport& transport, const scene::TetMeshView& part,
                                         std::span<const std::uint64_t> global_tet, const scene::MeshFacts& facts) {
  const scene::FieldSamples own = scene::sample_mesh(part, global_tet, facts);
  exchange::Bytes message = exchange::begin_message(MessageKind::field_samples);
  exchange::append_list(message, own.samples);
  scene::FieldSamples all{{}, own.sides, own.longest};
  int from = 0;
  for (const exchange::Bytes& bytes : exchange::gather_all(transport, std::move(message))) {
    exchange::MessageReader reader(bytes, from++, MessageKind::field_samples);
    const auto count = reader.take<std::uint64_t>();
    reader.take_onto(all.samples, count);
    reader.finish();
  }
  // A tet and all its samples are on one rank, so this is the order of a single process.
  std::ranges::stable_sort(all.samples, {}, &scene::FieldSample::tet);
  return all;
}

}  // namespace tessera::frame
