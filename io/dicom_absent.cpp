// Built in place of foreign_dicom.cpp with TESSERA_DICOM=OFF.
#include <fmt/format.h>

#include "io/volume_formats.hpp"

namespace tessera::io {

bool has_dicom() { return false; }

VolumeFile read_dicom(const std::filesystem::path& file, const VolumeOptions& /*options*/) {
  throw scene::bad_input(
      fmt::format("{}: DICOM files need GDCM, which this build leaves out; build with TESSERA_DICOM=ON, or convert "
                  "them to .nii.gz with dcm2niix",
                  file.string()));
}

}  // namespace tessera::io
