#pragma once

#include "apps/render_options.hpp"
#include "frame/mesh_input.hpp"
#include "io/transfer_function_file.hpp"
#include "scene/mesh_facts.hpp"

/// The mesh that a command is about, and what stands in for the options that were not given.
namespace tessera::apps {

using frame::default_unit_distance;
using frame::diagonal;
using frame::read_input;

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

/// The options with which later steps of a time series are read: their field is the one that was chosen for the first
/// step. A field that varies in one step and not in the next would else make the film jump to another.
io::MeshOptions options_of_later_steps(io::MeshOptions options, const io::MeshFile& first);

/// The transfer function that the options name, or the default one, over the range of the mesh's scalars.
colormaps::LoadedTransferFunction transfer_function_of(const scene::MeshFacts& facts, const RenderOptions& options);

}  // namespace tessera::apps
