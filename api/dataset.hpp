// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <mutex>
#include <optional>
#include <vector>

#include "api/state_access.hpp"
#include "exchange/transport.hpp"
#include "frame/ranks/field_of_all.hpp"
#include "frame/ranks/mesh_exchange.hpp"
#include "io/mesh/mesh_reader.hpp"
#include "io/volume/volume_reader.hpp"
#include "projection/prepared_mesh.hpp"
#include "scene/error.hpp"
#include "scene/mesh_facts.hpp"
#include "scene/sample_source.hpp"
#include "tessera/dataset.hpp"
#include "tessera/default_view.hpp"
#include "volume/bricks/cell_ranges.hpp"

namespace tessera {
inline namespace v0_1 {

/// What a Dataset holds. Nothing changes once it is made; what is prepared on demand is prepared once.
struct TESSERA_HIDDEN Dataset::State {
  std::string source, format, field_name;
  std::vector<FieldInfo> fields;
  std::vector<std::string> notes, blocks, surfaces;
  scene::TimeStepRead time_step;
  glm::dvec3 axis_scale{1};  ///< that the file's axes were multiplied by
  scene::MeshFacts facts;    ///< of the whole; grids have no tets
  /// What a selection (ReadOptions::selection) left out is in these; null: nothing was left out.
  std::shared_ptr<const frame::FieldOfAll> of_all;
  MeshCounts counts;
  HigherOrderCells higher_order;
  /// Files that the whole mesh can be read from again, by one rank that verifies; none: arrays.
  std::vector<std::filesystem::path> files;
  ReadOptions options;

  // Meshes.
  scene::TetMeshView mesh;                ///< this rank's part, or the whole
  std::shared_ptr<const void> owner;      ///< of its arrays
  int ranks = 1;                          ///< more than 1: a part, one a rank
  std::vector<std::uint64_t> global_tet;  ///< of a part: index of each tet in the whole
  bool shape = false;                     ///< the scalar is ReadOptions::shape's
  std::vector<HalfSpace> clip;            ///< what `mesh` was cut by
  std::shared_ptr<const State> uncut;     ///< before that; null: as `files` have it

  // Grids.
  std::shared_ptr<const scene::SampleSource> samples;  ///< null: a mesh
  std::shared_ptr<const volume::CellRanges> ranges;
  BodyAxes body_axes = BodyAxes::none;
  io::VolumeTags tags;
  /// All values of labels; empty: they are no labels, or too many; none: not looked at.
  std::optional<std::vector<double>> labels;

  /// Colours and opacities go by these, so that a selection changes none.
  [[nodiscard]] const scene::MeshFacts& facts_of_all() const { return of_all ? of_all->facts : facts; }

  /// The mesh prepared for projection, shared by sessions.
  [[nodiscard]] std::shared_ptr<const projection::PreparedMesh> prepared(int threads,
                                                                         scene::Trace* trace = nullptr) const;

  /// Points of the field over the whole, what a selection left out included. Of a mesh in parts they have to be
  /// gathered by all ranks first.
  [[nodiscard]] const scene::FieldSamples& field_samples() const;
  /// The whole's, of a mesh in parts. Collective.
  void gather_field_samples(exchange::Transport& transport);

 private:
  mutable std::once_flag once_, sampled_;
  mutable scene::FieldSamples field_samples_;
  mutable std::shared_ptr<const projection::PreparedMesh> prepared_;
};

}  // namespace v0_1

namespace api {

scene::MeshFacts facts_of_grid(const scene::Grid& grid, const scene::ValueRange& range);

/// Facts of a grid whose samples and ranges are known.
void complete_grid(Dataset::State& state);

/// This rank's error ends the run for all, and the run's one error is thrown on each.
template <class Work>
auto together(exchange::Transport& transport, const Work& work) {
  try {
    return work();
  } catch (const scene::Error& error) {
    if (transport.size() > 1) {
      transport.fail(error);
      transport.check();
    }
    throw;
  }
}

}  // namespace api
}  // namespace tessera
