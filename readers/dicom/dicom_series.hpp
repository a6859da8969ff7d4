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
  /// The steps from one sample to the next along a row, from row to row, and from slice to slice. If slices are not
  /// uniform, the last step has length one.
  std::array<glm::dvec3, 3> steps{};
  std::vector<double> places;  ///< positions of non-uniform slices along the last step, from 0; otherwise empty
  std::vector<std::string> notes;
  scene::TimeStepRead time_step{};
};

/// Selects one volume: the series that contains the file `named`, otherwise the series with the most slices. If it has
/// several times, selects the requested time, otherwise the last. Slices whose size or direction differ from those of
/// most slices are left out, with a note. Throws Error(bad_input).
DicomVolume volume_of(std::vector<DicomSlice> slices, const std::filesystem::path& named,
                      std::optional<std::size_t> time_step, const std::string& source);

}  // namespace tessera::readers
