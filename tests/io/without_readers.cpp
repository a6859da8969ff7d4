// Other people's readers are not fuzzed.
#include "io/volume_formats.hpp"
#include "io/volume_reader.hpp"

namespace tessera::io {
namespace {

[[noreturn]] void refuse(const std::filesystem::path& file) { throw damaged(file, "another library reads it"); }

}  // namespace

VolumeFile read_vtk_grid(const std::filesystem::path& file, const VolumeOptions& /*options*/) { refuse(file); }
bool holds_grid_by_vtk(const std::filesystem::path& /*file*/, const char* /*reader*/) { return false; }
VolumeFile read_by_vtk(const std::filesystem::path& file, const char* /*reader*/, const VolumeOptions& /*options*/) {
  refuse(file);
}
bool holds_xdmf_grid(const std::filesystem::path& /*file*/) { return false; }
VolumeFile read_xdmf_grid(const std::filesystem::path& file, const VolumeOptions& /*options*/) { refuse(file); }
VolumeFile read_dicom(const std::filesystem::path& file, const VolumeOptions& /*options*/) { refuse(file); }

}  // namespace tessera::io
