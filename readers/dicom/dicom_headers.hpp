// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <span>
#include <vector>

#include "readers/dicom/dicom_slice.hpp"

namespace tessera::readers {

/// Returns the headers of those files that are DICOM images. GDCM checks many conditions by assertions, which end the
/// process. Headers are therefore read in a process forked from this helper; if that process dies, another one
/// continues with the next file. A file for which GDCM aborts is treated as if it were not an image.
std::vector<DicomSlice> read_dicom_headers(std::span<const std::filesystem::path> files);

}  // namespace tessera::readers
