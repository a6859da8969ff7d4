// SPDX-License-Identifier: BSD-3-Clause
// DICOM series, read by a helper of their own.
#include "io/foreign/foreign_mixed.hpp"
#include "io/volume/volume_formats.hpp"

namespace tessera::io {

VolumeFile read_dicom(const std::filesystem::path& file, const VolumeOptions& options) {
  HelperTask task;
  task.reader = Reader::dicom;
  return read_foreign_volume(file, {"dicom", std::move(task)}, options);
}

}  // namespace tessera::io
