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

/// The contents of a Dataset. They are immutable after construction; values that are computed on demand are computed
/// once.
struct TESSERA_HIDDEN Dataset::State {
  std::string source, format, field_name;
  std::vector<FieldInfo> fields;
  std::vector<std::string> notes, blocks, surfaces;
  scene::TimeStepRead time_step;
  glm::dvec3 axis_scale{1};  ///< factors by which the file's axes are multiplied
  scene::MeshFacts facts;    ///< facts of the whole data set; for grids the number of tets is 0
  /// The field of the whole data, including the part that a selection (ReadOptions::selection) left out; null: nothing
  /// was left out.
  std::shared_ptr<const frame::FieldOfAll> of_all;
  MeshCounts counts;
  HigherOrderCells higher_order;
  /// Files from which one rank can read the whole mesh again, for verification; empty: the data come from arrays.
  std::vector<std::filesystem::path> files;
  ReadOptions options;

  // Meshes.
  scene::TetMeshView mesh;                ///< this rank's part or the whole mesh
  std::shared_ptr<const void> owner;      ///< owner of the mesh's arrays
  int ranks = 1;                          ///< if more than 1, each rank has one part of the mesh
  std::vector<std::uint64_t> global_tet;  ///< if this is a part: index of each tet in the whole mesh
  bool shape = false;                     ///< the scalar is the one described at ReadOptions::shape
  std::vector<HalfSpace> clip;            ///< half-spaces that cut `mesh`
  std::shared_ptr<const State> uncut;     ///< the data before they were cut; null: they can be read from `files`

  // Grids.
  std::shared_ptr<const scene::SampleSource> samples;  ///< null: a mesh
  std::shared_ptr<const volume::CellRanges> ranges;
  BodyAxes body_axes = BodyAxes::none;
  io::VolumeTags tags;
  /// All values that occur, if the values are labels. Empty: they are not labels, or there are too many values. None:
  /// not examined.
  std::optional<std::vector<double>> labels;

  /// Facts about the data before any selection. Colours and opacities depend on them, so that a selection does not
  /// change these.
  [[nodiscard]] const scene::MeshFacts& facts_of_all() const { return of_all ? of_all->facts : facts; }

  /// The mesh prepared for projection, shared by sessions.
  [[nodiscard]] std::shared_ptr<const projection::PreparedMesh> prepared(int threads,
                                                                         scene::Trace* trace = nullptr) const;

  /// Samples of the field over the whole data set, including the part that a selection left out. For a mesh in parts,
  /// gather_field_samples() must be called first.
  [[nodiscard]] const scene::FieldSamples& field_samples() const;
  /// For a mesh in parts: gathers the samples of the whole mesh. Collective.
  void gather_field_samples(exchange::Transport& transport);

 private:
  mutable std::once_flag once_, sampled_;
  mutable scene::FieldSamples field_samples_;
  mutable std::shared_ptr<const projection::PreparedMesh> prepared_;
};

}  // namespace v0_1

namespace api {

scene::MeshFacts facts_of_grid(const scene::Grid& grid, const scene::ValueRange& range);

/// Computes the facts of a grid whose samples and ranges are known.
void complete_grid(Dataset::State& state);

/// Runs `work`. An error on this rank ends the run for all ranks, and every rank throws the run's error.
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
