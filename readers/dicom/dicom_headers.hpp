// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <span>
#include <vector>

#include "readers/dicom/dicom_slice.hpp"

namespace tessera::readers {

/// The headers of those files that are DICOM images. GDCM checks much by assertions, which end the process: headers are
/// read in a process forked from this helper; if that dies, another continues with the next file. A file that makes
/// GDCM abort counts as not being an image.
std::vector<DicomSlice> read_dicom_headers(std::span<const std::filesystem::path> files);

}  // namespace tessera::readers
