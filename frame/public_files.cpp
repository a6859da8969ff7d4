// The public functions that read and write files, by io/'s.
#include "frame/dataset.hpp"
#include "io/camera_file.hpp"
#include "io/image_deep_exr.hpp"
#include "io/image_file.hpp"
#include "io/mesh_reader.hpp"
#include "io/volume_writer.hpp"
#include "scene/error.hpp"
#include "tessera/image_file.hpp"
#include "tessera/view.hpp"
#include "tessera/write.hpp"

namespace tessera {

std::vector<CameraFile> read_cameras(const std::filesystem::path& file) { return io::read_cameras(file); }
void write_camera(const CameraFile& camera, const std::filesystem::path& file) { io::write_camera(camera, file); }

void write_image(const Image& image, const std::filesystem::path& file, const ImageFileOptions& options) {
  io::write_image(image, file, options);
}
Image read_image(const std::filesystem::path& file) { return io::read_image(file); }

void write_deep_image(const DeepImage& image, const std::filesystem::path& file) {
  if (file.extension() != ".exr") throw scene::bad_input(file.string() + ": deep pictures are OpenEXR; name it .exr");
  io::write_deep_exr(image, file);
}

void write_mesh(const Dataset& mesh, const std::filesystem::path& file) {
  const Dataset::State& state = mesh.state();
  if (mesh.is_grid()) throw scene::bad_input(state.source + ": is a grid, no mesh; use write_grid");
  if (state.ranks > 1)
    throw scene::bad_input(state.source + ": this rank has a part of the mesh; open it on one rank to write it");
  scene::TetMeshView view = state.mesh;
  view.field_name = state.field_name;
  if (file.extension() == ".tets") return io::write_tets(view, file);
  if (file.extension() == ".vtu") return io::write_vtu(view, file);
  throw scene::bad_input(file.string() + ": is no name of a mesh that can be written; choose .vtu or .tets");
}

void write_grid(const Dataset& grid, const std::filesystem::path& file, int block) {
  const Dataset::State& state = grid.state();
  if (grid.is_mesh()) throw scene::bad_input(state.source + ": is a mesh, no grid; use write_mesh");
  if (!io::is_volume_output(file))
    throw scene::bad_input(file.string() +
                           ": is no name of a grid that can be written; choose .vti, .vtr, .nrrd, .raw or .bricks");
  io::write_volume(*state.samples, file, block);
}

}  // namespace tessera
