// SPDX-License-Identifier: BSD-3-Clause
#include "io/mesh/block_surface.hpp"

#include <fmt/format.h>

#include "api/dataset.hpp"
#include "frame/mesh/boundary_faces.hpp"
#include "frame/mesh/mesh_input.hpp"
#include "scene/error.hpp"
#include "scene/threads.hpp"
#include "tessera/program/text.hpp"
#include "tessera/triangle_file.hpp"

namespace tessera {
inline namespace v0_1 {

TriangleMesh read_block_surface(std::span<const std::filesystem::path> files, const std::string& block,
                                const ReadOptions& options) {
  if (files.empty()) throw scene::bad_input("input: no file was given; give one");
  ReadOptions read = options;
  read.blocks = {block};
  read.selection = {};
  io::BlockFaces faces =
      io::read_block_faces(frame::identify_pieces(files, frame::identify_input(files.front())), read);
  if (!faces.has_volume) {
    if (faces.mesh.triangles.empty())
      throw scene::bad_input(fmt::format("{}: the block {} has neither faces nor cells; name another",
                                         files.front().string(), quote(block)));
    return std::move(faces.mesh);
  }
  read.grid_as_mesh = true;
  const Dataset volume = Dataset::open(files, read);
  TriangleMesh boundary =
      scene::with_threads(options.threads, [&] { return frame::boundary_faces(StateAccess::of(volume).mesh).mesh; });
  if (boundary.triangles.empty())
    throw scene::bad_input(
        fmt::format("{}: the block {} has no boundary; name another", files.front().string(), quote(block)));
  if (volume.field_name() != options.field && !options.field.empty() && volume.shows_shape()) boundary.values.clear();
  return boundary;
}

}  // namespace v0_1
}  // namespace tessera
