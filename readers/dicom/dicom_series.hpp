// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "readers/dicom/dicom_slice.hpp"
#include "scene/time_step_read.hpp"

namespace tessera::readers {

/// Slices that are one volume, in the order of their places along the normal.
struct DicomVolume {
  std::vector<DicomSlice> slices;  ///< one of each place
  glm::dvec3 origin{0};            ///< of the first sample
  /// One step of the index along rows' samples, rows, and slices; of uneven slices the last of length one.
  std::array<glm::dvec3, 3> steps{};
  std::vector<double> places;  ///< of uneven slices along the last step, from 0; else empty
  std::vector<std::string> notes;
  scene::TimeStepRead time_step{};
};

/// The series that the named file is of, else the one with the most slices; of several times the chosen one, else the
/// last. Slices of another size or direction than most of theirs are left out, with a note. Throws Error(bad_input).
DicomVolume volume_of(std::vector<DicomSlice> slices, const std::filesystem::path& named,
                      std::optional<std::size_t> time_step, const std::string& source);

}  // namespace tessera::readers
