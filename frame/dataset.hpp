#pragma once

#include <memory>
#include <mutex>
#include <vector>

#include "frame/mesh_exchange.hpp"
#include "io/mesh_reader.hpp"
#include "projection/prepared_mesh.hpp"
#include "scene/mesh_facts.hpp"
#include "scene/sample_source.hpp"
#include "tessera/dataset.hpp"
#include "volume/cell_ranges.hpp"

namespace tessera {

/// What a Dataset holds. Nothing changes once it is made; what is prepared on demand is prepared once.
struct TESSERA_HIDDEN Dataset::State {
  std::string source, format, field_name;
  std::vector<FieldInfo> fields;
  std::vector<std::string> notes, blocks;
  scene::MeshFacts facts;  ///< of the whole; grids have no tets
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

  // Grids.
  std::shared_ptr<const scene::SampleSource> samples;  ///< null: a mesh
  std::shared_ptr<const volume::CellRanges> ranges;

  /// The mesh prepared for projection, shared by sessions.
  [[nodiscard]] std::shared_ptr<const projection::PreparedMesh> prepared(int threads,
                                                                         scene::Trace* trace = nullptr) const;

 private:
  mutable std::once_flag once_;
  mutable std::shared_ptr<const projection::PreparedMesh> prepared_;
};

namespace frame {

io::MeshOptions mesh_options(const ReadOptions& options);

}  // namespace frame
}  // namespace tessera
