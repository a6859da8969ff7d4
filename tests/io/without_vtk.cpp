// VTK's readers are not fuzzed.
#include "io/volume_formats.hpp"
#include "io/volume_reader.hpp"

namespace tessera::io {

VolumeFile read_vtk_grid(const std::filesystem::path& file, const VolumeOptions& /*options*/) {
  throw damaged(file, "it is VTK's");
}
bool holds_grid_by_vtk(const std::filesystem::path& /*file*/, const char* /*reader*/) { return false; }
VolumeFile read_by_vtk(const std::filesystem::path& file, const char* /*reader*/, const VolumeOptions& /*options*/) {
  throw damaged(file, "it is VTK's");
}

}  // namespace tessera::io
