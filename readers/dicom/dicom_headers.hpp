// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <span>
#include <vector>

#include "readers/dicom/dicom_slice.hpp"

namespace tessera::readers {

/// The headers of those files that are DICOM pictures. GDCM checks much by assertions, which end the process: headers
/// are read in one forked from this helper, and from the next file on in another where that dies. One file among many
/// that GDCM cannot stand is none of theirs.
std::vector<DicomSlice> read_dicom_headers(std::span<const std::filesystem::path> files);

}  // namespace tessera::readers
