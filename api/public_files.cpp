// SPDX-License-Identifier: BSD-3-Clause
// The public functions that read and write files, implemented with those of io/.
#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "api/dataset.hpp"
#include "api/input_file.hpp"
#include "frame/mesh/array_mesh.hpp"
#include "io/formats/identify.hpp"
#include "io/image/image_deep_exr.hpp"
#include "io/image/image_file.hpp"
#include "io/mesh/mesh_parts.hpp"
#include "io/mesh/mesh_reader.hpp"
#include "io/mesh/pvtu_writer.hpp"
#include "io/mesh/triangle_file.hpp"
#include "io/scene/camera_file.hpp"
#include "io/scene/json_transfer_function.hpp"
#include "io/scene/time_series.hpp"
#include "io/text/json_text.hpp"
#include "io/volume/volume_reader.hpp"
#include "io/volume/volume_writer.hpp"
#include "projection/partition.hpp"
#include "projection/planes_rasterizer.hpp"
#include "scene/error.hpp"
#include "scene/label_source.hpp"
#include "scene/threads.hpp"
#include "system/missing_file.hpp"
#include "tessera/image_file.hpp"
#include "tessera/input_file.hpp"
#include "tessera/program/output_file.hpp"
#include "tessera/statistics.hpp"
#include "tessera/triangle_file.hpp"
#include "tessera/view.hpp"
#include "tessera/write.hpp"

namespace tessera {
inline namespace v0_1 {

std::vector<CameraFile> read_cameras(const std::filesystem::path& file) { return io::read_cameras(file); }
std::vector<CameraFile> parse_cameras(std::string_view text, const std::string& name) {
  return io::parse_cameras(text, name);
}
bool is_json_text(std::string_view file_or_json) { return io::is_json_text(file_or_json); }
std::vector<CameraFile> cameras_of(const std::string& file_or_json) {
  return is_json_text(file_or_json) ? parse_cameras(file_or_json, "`camera`") : read_cameras(file_or_json);
}
std::string camera_json(const CameraFile& camera) { return io::camera_json(camera); }
void write_camera(const CameraFile& camera, const std::filesystem::path& file) { io::write_camera(camera, file); }

std::string transfer_function_json(const TransferFunction& function) { return io::knots_json(function); }
std::string paraview_json(const TransferFunction& function, double unit_distance, const std::string& name) {
  return io::color_map_json(function, unit_distance, name);
}

void write_image(const Image& image, const std::filesystem::path& file, const ImageFileOptions& options) {
  io::write_image(image, file, options);
}
std::vector<std::byte> png_bytes(const Image& image, const ImageFileOptions& options) {
  return io::checked_png_bytes(image, options);
}
std::vector<std::byte> exr_bytes(const Image& image, const ImageFileOptions& options) {
  return io::checked_exr_bytes(image, options);
}
std::vector<std::byte> jpeg_bytes(const Image& image, const ImageFileOptions& options) {
  return io::checked_jpeg_bytes(image, options);
}
Image read_image(const std::filesystem::path& file) { return io::read_image(file); }
TriangleMesh read_triangles(const std::filesystem::path& file) { return io::read_triangles(io::identify(file)); }

void write_deep_image(const DeepImage& image, const std::filesystem::path& file) {
  if (file.extension() != ".exr")
    throw scene::bad_input(file.string() + ": deep images are OpenEXR files; give a name that ends in .exr");
  io::write_deep_exr(image, file);
}

bool is_deep_name(const std::filesystem::path& file) { return io::is_deep_name(file); }
void check_image_path(const std::filesystem::path& file) { io::check_image_path(file); }

void require_input(const std::filesystem::path& input) { io::require_input(input); }
void require_grid(const std::filesystem::path& file) { io::require_volume(io::identify(file)); }
void require_mesh(const std::filesystem::path& file) { io::require_mesh(io::identify(file)); }
std::string read_text(const std::filesystem::path& file) {
  std::error_code unknown;
  if (std::filesystem::is_directory(file, unknown))
    throw scene::bad_input(file.string() + ": is a directory; name a file in it");
  const system::PositionalFile opened = io::open_input(file);
  return opened.beginning(opened.size());
}
void check_json(std::string_view text, const std::string& source, std::size_t most_values) {
  io::parse_json(text, source, most_values);
}
std::optional<SampleType> sample_type_named(const std::string& name) { return io::parse_sample_type(name); }

namespace {

void write_tets_of(const scene::TetMeshView& mesh, const std::filesystem::path& file) {
  if (file.extension() == ".tets") return io::write_tets(mesh, file);
  if (file.extension() == ".vtu") return io::write_vtu(mesh, file);
  throw scene::bad_input(file.string() +
                         ": its name is not that of a mesh format that can be written; choose .vtu or .tets");
}

}  // namespace

void write_mesh(const Dataset& mesh, const std::filesystem::path& file) {
  const Dataset::State& state = StateAccess::of(mesh);
  if (mesh.is_grid()) throw scene::bad_input(state.source + ": it is a grid, not a mesh; use write_grid");
  if (state.ranks > 1)
    throw scene::bad_input(state.source + ": this rank has a part of the mesh; open it on one rank to write it");
  scene::TetMeshView view = state.mesh;
  view.field_name = state.field_name;
  write_tets_of(view, file);
}

void write_mesh(const MeshArrays& mesh, const std::filesystem::path& file) {
  write_tets_of(frame::mesh_to_write(mesh).mesh, file);
}

void write_mesh_pieces(const MeshArrays& arrays, const std::filesystem::path& file, int pieces,
                       const Partition& partition) {
  const frame::ArrayMesh mesh = frame::mesh_to_write(arrays);
  const std::vector<std::uint32_t> part_of = projection::parts_of_whole(mesh.mesh, partition, pieces);
  std::vector<std::vector<std::uint32_t>> tets(static_cast<std::size_t>(pieces));
  for (std::size_t t = 0; t < part_of.size(); ++t) tets[part_of[t]].push_back(static_cast<std::uint32_t>(t));
  io::PvtuWriter writer(file, mesh.mesh);
  for (auto& piece : tets) {
    writer.add(scene::subset(mesh.mesh, piece));
    piece = {};
  }
  writer.commit();
}

void check_mesh_output(const std::filesystem::path& file, const InputFile* input, std::optional<int> pieces) {
  const InputFile::Found* const found = input == nullptr ? nullptr : &StateAccess::of(*input);
  if (found != nullptr && !found->is_there) throw system::missing_file(input->path());
  if (found != nullptr) io::require_mesh(found->file);  // first: no output suits an input that is not a mesh
  const std::filesystem::path read = input == nullptr ? std::filesystem::path() : input->path();
  const auto extension = file.extension();
  if (!pieces) {
    if (extension == ".pvtu")
      throw scene::bad_input(
          fmt::format("{}: only convert `pieces` writes a mesh in pieces; choose .vtu or .tets", file.string()));
    if (extension != ".vtu" && extension != ".tets")
      throw scene::bad_input(fmt::format("{}: '{}' is not a mesh format to write; choose .vtu or .tets", file.string(),
                                         extension.string()));
    return check_output(file, read);
  }
  if (extension != ".pvtu")
    throw scene::bad_input(fmt::format("{}: `pieces` writes a .pvtu; give the name of a .pvtu", file.string()));
  std::vector<std::filesystem::path> inputs = {read};
  if (found != nullptr && io::readable_in_parts(found->file, {})) {
    const auto parts = io::files_of_parts(found->file);
    inputs.insert(inputs.end(), parts.begin(), parts.end());
  }
  for (const auto& one : inputs) {
    check_output(file, one);
    for (int p = 0; p < *pieces; ++p) {
      const auto name = io::pvtu_piece_name(file, p);
      std::error_code absent;
      if (std::filesystem::exists(name, absent)) check_output(name, one);
    }
  }
}

namespace {

void check_grid_name(const std::filesystem::path& file) {
  if (!io::is_volume_output(file))
    throw scene::bad_input(
        file.string() +
        ": its name is not that of a grid format that can be written; choose .vti, .vtr, .nrrd, .raw or .bricks");
}

}  // namespace

void write_grid(const Dataset& grid, const std::filesystem::path& file, int block) {
  const Dataset::State& state = StateAccess::of(grid);
  if (grid.is_mesh()) throw scene::bad_input(state.source + ": it is a mesh, not a grid; use write_mesh");
  check_grid_name(file);
  // Labels are written as they were in the file, as point data.
  const auto* const labels = dynamic_cast<const scene::LabelSource*>(state.samples.get());
  io::write_volume(labels == nullptr ? *state.samples : labels->points(), file, block, state.body_axes, state.tags);
}

void write_grid(const SampleSource& grid, const std::filesystem::path& file, int block) {
  check_grid_name(file);
  io::write_volume(grid, file, block);
}

bool is_grid_output(const std::filesystem::path& file) { return io::is_volume_output(file); }

SampleType written_type(const Dataset& grid) {
  if (grid.is_mesh())
    throw scene::bad_input(grid.source() + ": it is a mesh, which has no samples; request them only from grids");
  return io::written_type(StateAccess::of(grid).samples->grid());
}

int threads_for(int asked) { return scene::threads_for(asked); }
std::string instruction_set() { return projection::instruction_set(); }

}  // namespace v0_1
}  // namespace tessera
