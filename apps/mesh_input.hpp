#pragma once

#include "apps/render_options.hpp"
#include "io/transfer_function_file.hpp"
#include "scene/mesh_facts.hpp"

/// The mesh that a command is about, and what stands in for the options that were not given.
namespace tessera::apps {

/// What the report and the line of a run say of a mesh: all but the mesh itself, of which a rank may hold a part.
struct MeshSummary {
  io::MeshCounts counts;
  std::vector<io::FieldSummary> fields;
  std::vector<std::string> notes;
  std::string format, field_name;
  scene::MeshFacts facts;
};
/// `threads`: 0 is all cores.
MeshSummary summary_of(const io::MeshFile& file, int threads = 0);
/// Where the file's mesh is in parts, with the facts of the whole.
MeshSummary summary_of(const io::MeshFile& description, const scene::MeshFacts& facts);

/// io::read_mesh, but a regular grid or time series is refused as one. Throws scene::Error.
io::MeshFile read_input(const std::filesystem::path& input, const io::MeshOptions& options);
/// Several files are the pieces of one mesh.
io::MeshFile read_input(std::span<const std::filesystem::path> files, const io::MeshOptions& options);

/// The options with which later steps of a time series are read: their field is the one that was chosen for the first
/// step. A field that varies in one step and not in the next would else make the film jump to another.
io::MeshOptions options_of_later_steps(io::MeshOptions options, const io::MeshFile& first);

/// Length of a box's diagonal, world units; 0 if it has no extent.
double diagonal(const scene::Box& box);

/// The length over which an opacity holds where neither file nor user says it, world units: a tenth of the mesh's mean
/// thickness, so that the presets' ramps (0.03 to 0.2) make an average ray 0.26 to 0.89 opaque, in plates and scattered
/// parts too. A mesh of no volume: a twentieth of its diagonal; of no extent: 1.
double default_unit_distance(const scene::MeshFacts& facts);

/// The transfer function that the options name, or the default one, over the range of the mesh's scalars.
colormaps::LoadedTransferFunction transfer_function_of(const scene::MeshFacts& facts, const RenderOptions& options);

}  // namespace tessera::apps
