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

/// What one rank gets of a mesh that several read together.
struct DistributedMesh {
  MeshPart part;                             ///< this rank's tets; none on ranks that do not project
  scene::MeshFacts facts;                    ///< of the whole
  std::shared_ptr<const FieldOfAll> of_all;  ///< null: the options select everything
  /// What io::read_mesh says of the whole, the same on every rank, but for the mesh: that has its field and association
  /// only.
  cells::MeshFile description;
};

/// Reads a mesh and gives every projector its part. Collective.
///
/// Several files are the pieces of one mesh; `first` is the first of them, identified. One file of a format that can be
/// read in parts (io::readable_in_parts) is read by all projectors at once, each its share; anything else by the first
/// projector, which hands it on: one read, where every rank reading in turn would be many. The tets' numbers, and so
/// every picture, do not depend on how it was read. With one rank it is io::read_mesh and nothing more. Spans `read`
/// and `partition`. An error of one rank is transport.fail()ed and thrown on all. Times go to
/// `trace` in place of `options.trace`.
DistributedMesh read_distributed(exchange::Transport& transport, std::span<const std::filesystem::path> files,
                                 const io::InputFile& first, const ReadOptions& options,
                                 const projection::Partition& partition, std::span<const int> projectors,
                                 scene::Trace* trace);

}  // namespace tessera::frame
