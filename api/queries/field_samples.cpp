// SPDX-License-Identifier: BSD-3-Clause
// Takes a data set's samples once; for a mesh in parts all ranks take them together.
#include "scene/field_samples.hpp"

#include "api/dataset.hpp"

namespace tessera {
inline namespace v0_1 {

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

}  // namespace v0_1
}  // namespace tessera
