#include "io/mesh_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>

#include "io/tets_file.hpp"
#include "scene/error.hpp"

namespace tessera::io {
namespace {

std::vector<std::byte> read_bytes(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary | std::ios::ate);
  if (!in) throw scene::bad_input(fmt::format("{}: cannot be opened; check name and permission", file.string()));
  std::vector<std::byte> bytes(static_cast<std::size_t>(in.tellg()));
  in.seekg(0);
  in.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
  if (!in) throw scene::bad_input(fmt::format("{}: cannot be read; check the disk", file.string()));
  return bytes;
}

std::string extension_of(const std::filesystem::path& file) {
  std::string extension = file.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return std::tolower(c); });
  return extension;
}

}  // namespace

bool is_mesh_file(const std::filesystem::path& file) { return extension_of(file) == ".tets"; }

MeshFile read_mesh(const std::filesystem::path& file, const MeshOptions&) {
  if (extension_of(file) != ".tets")
    throw scene::bad_input(fmt::format("{}: only .tets is read so far; convert it", file.string()));
  MeshFile result;
  result.format = ".tets";
  result.mesh = parse_tets(read_bytes(file), file.string());
  result.counts.cells_read = result.counts.tets_made = result.mesh.tets.size();
  result.counts.points_read = result.mesh.positions.size();
  scene::validate(result.mesh, file.string());
  return result;
}

}  // namespace tessera::io
