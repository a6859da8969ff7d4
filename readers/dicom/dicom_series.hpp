// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "readers/dicom/dicom_slice.hpp"
#include "scene/time_step_read.hpp"

namespace tessera::readers {

/// Slices that form one volume, sorted by their positions along the normal.
struct DicomVolume {
  std::vector<DicomSlice> slices;  ///< one per position
  glm::dvec3 origin{0};            ///< position of the first sample
  /// One step of the index along the samples of a row, along rows, and along slices; if slices are not uniform the last
  /// has length one.
  std::array<glm::dvec3, 3> steps{};
  std::vector<double> places;  ///< for non-uniform slices, along the last step, from 0; else empty
  std::vector<std::string> notes;
  scene::TimeStepRead time_step{};
};

/// The series of the named file, otherwise the one with the most slices. If there are several times: the chosen one,
/// otherwise the last. Slices of another size or direction than the majority are left out, with a note. Throws
/// Error(bad_input).
DicomVolume volume_of(std::vector<DicomSlice> slices, const std::filesystem::path& named,
                      std::optional<std::size_t> time_step, const std::string& source);

}  // namespace tessera::readers
