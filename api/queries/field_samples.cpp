// How a data set's samples are taken, once; of a mesh in parts by all ranks together.
#include "scene/field_samples.hpp"

#include <algorithm>
#include <utility>

#include "api/dataset.hpp"
#include "exchange/collectives.hpp"

namespace tessera {

using exchange::MessageKind;

const scene::FieldSamples& Dataset::State::field_samples() const {
  if (of_all) return of_all->samples;
  if (ranks == 1)
    std::call_once(sampled_, [&] {
      field_samples_ = samples != nullptr ? scene::sample_grid(*samples) : scene::sample_mesh(mesh, global_tet, facts);
    });
  return field_samples_;
}

void Dataset::State::gather_field_samples(exchange::Transport& transport) {
  if (ranks > 1 && !of_all) field_samples_ = frame::gather_field_samples(transport, mesh, global_tet, facts);
}

namespace frame {

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
  // A tet is on one rank, with all its samples: the order of one process.
  std::ranges::stable_sort(all.samples, {}, &scene::FieldSample::tet);
  return all;
}

}  // namespace frame
}  // namespace tessera
