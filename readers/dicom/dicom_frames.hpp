// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <gdcmDataSet.h>

#include "readers/dicom/dicom_slice.hpp"

namespace tessera::readers {

/// Sets the position, scale and time of each frame of a multi-frame file: slice.each, spacing and frames_note. Frames
/// without values of their own use the values of the file, which `slice` must contain already.
///
/// Source  DICOM PS3.3, C.7.6.16 (functional groups, shared and per frame: plane position and orientation, pixel
///         measures, pixel value transformation, frame content, cardiac synchronization); C.8.8.3 (RT dose: grid frame
///         offset vector, dose grid scaling); C.8.4.8 and C.8.4.9 (nuclear medicine: slice, phase and time slot
///         vectors, detector information).
/// Default Frames without positions are stacked along the normal. Their distance is the spacing between slices,
///         otherwise the slice thickness, otherwise one millimetre; frames_note mentions which of these was used.
void set_frames(const gdcm::DataSet& data, DicomSlice& slice);

}  // namespace tessera::readers
