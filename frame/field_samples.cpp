// How a data set's samples are taken, once; of a mesh in parts by all ranks together.
#include "scene/field_samples.hpp"

#include <algorithm>
#include <utility>

#include "exchange/collectives.hpp"
#include "frame/dataset.hpp"

namespace tessera {

using exchange::MessageKind;

const scene::FieldSamples& Dataset::State::field_samples() const {
  if (ranks == 1)
    std::call_once(sampled_, [&] {
      field_samples_ = samples != nullptr ? scene::sample_grid(*samples) : scene::sample_mesh(mesh, global_tet, facts);
    });
  return field_samples_;
}

void Dataset::State::gather_field_samples(exchange::Transport& transport) {
  if (ranks == 1) return;
  scene::FieldSamples part = scene::sample_mesh(mesh, global_tet, facts);
  exchange::Bytes message = exchange::begin_message(MessageKind::field_samples);
  exchange::append_list(message, part.samples);
  field_samples_ = {{}, part.sides, part.longest};
  int from = 0;
  for (const exchange::Bytes& bytes : exchange::gather_all(transport, std::move(message))) {
    exchange::MessageReader reader(bytes, from++, MessageKind::field_samples);
    const auto count = reader.take<std::uint64_t>();
    reader.take_onto(field_samples_.samples, count);
    reader.finish();
  }
  // A tet is on one rank, with all its samples: the order of one process.
  std::ranges::stable_sort(field_samples_.samples, {}, &scene::FieldSample::tet);
}

}  // namespace tessera
