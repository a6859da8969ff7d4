// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <memory>
#include <span>

#include "exchange/transport.hpp"
#include "frame/ranks/field_of_all.hpp"
#include "frame/ranks/mesh_exchange.hpp"
#include "io/mesh/mesh_reader.hpp"
#include "projection/partition.hpp"
#include "scene/mesh_facts.hpp"
#include "scene/trace.hpp"

namespace tessera::frame {

/// One rank's part of a mesh that several ranks read together.
struct DistributedMesh {
  MeshPart part;           ///< this rank's tets; empty on ranks that do not project
  scene::MeshFacts facts;  ///< facts of the whole mesh
  /// Field and facts without the user's selection of cells; null: the options select everything.
  std::shared_ptr<const FieldOfAll> of_all;
  /// The result of io::read_mesh for the whole file, the same on every rank. Its mesh, however, contains only the
  /// field's name and association.
  cells::MeshFile description;
};

/// Reads a mesh and gives every projector its part. Collective.
///
/// Several files are the pieces of one mesh; `first` is the first of them, identified. A single file in a format that
/// can be read in parts (io::readable_in_parts) is read by all projectors at once; each reads its share. Anything else
/// is read only by the first projector, which distributes the mesh. The indices of the tets, and so every image, do not
/// depend on how the files were read. Records spans `read` and `partition`. Throws this rank's error, which the caller
/// passes to transport.fail(), or the run's error.
DistributedMesh read_distributed(exchange::Transport& transport, std::span<const std::filesystem::path> files,
                                 const io::InputFile& first, const ReadOptions& options,
                                 const projection::Partition& partition, std::span<const int> projectors);

}  // namespace tessera::frame
