// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "cells/field_summary.hpp"
#include "io/files/input_file.hpp"
#include "io/volume/volume_tags.hpp"
#include "scene/sample_source.hpp"
#include "scene/time_step_read.hpp"
#include "system/scratch_file.hpp"
#include "tessera/default_view.hpp"
#include "tessera/read_options.hpp"

namespace tessera::io {

/// A volume whose samples wait in the file or, where they had to be decompressed, in memory or a scratch file.
struct VolumeFile {
  std::unique_ptr<scene::SampleSource> source;
  std::shared_ptr<const system::ScratchFile>
      scratch;                              ///< where the source reads what was unpacked, for others too; else null
  bool in_memory = true;                    ///< all samples are, so that they could be unpacked or put together
  scene::ValueRange range;                  ///< of the chosen field, and its blanks; empty until set_range()
  std::vector<cells::FieldSummary> fields;  ///< low > high: not known until set_range()
  std::vector<std::string> notes;           ///< one line each: what was chosen or applied, or odd about the file
  std::string format;
  BodyAxes body_axes = BodyAxes::none;
  BodyAxes axes_if_ct = BodyAxes::none;  ///< set_range() makes them body_axes if the values are those of CT
  VolumeTags tags{};
  scene::TimeStepRead time_step{};
  bool beside_degrees = false;  ///< x and y are degrees, z is a length
};

/// Whether the file is a regular or rectilinear grid, or .raw. Of NetCDF, HDF5 and XDMF a helper looks, which takes
/// some hundredths of a second.
bool is_volume(const InputFile& file);

/// Throws Error(bad_input) of a mesh. Does not read samples.
void require_volume(const InputFile& file);

/// Opens a volume.
///
///   .vti .pvti .vtr .pvtr, .vtk of structured points or a rectilinear grid: by VTK, all of it in memory (a large .vti
///       or .vtr of one array: plain_vtk_grid.hpp). Extent, origin, spacing and direction apply; pieces have to fill
///       the whole and to agree on its coordinates. A curvilinear .vtk is a mesh. 64-bit integers become doubles.
///       Hidden samples are blank.
///   .mhd .mha: origin, spacing, orientation, slope and offset apply; raw (in place), compressed or text.
///   .nrrd .nhdr: space origin and directions, else axis minimums and spacings; raw (in place), gzip, ascii or hex. A
///       first axis of components is allowed; content "old min" and the measurement frame mean nothing here. Slices in
///       several files (LIST, NAME%03d), here and of MetaImage, are put together in memory.
///   .nii .nii.gz (NIfTI-1 and 2), or in two files .hdr and .img: sform, else qform, else the spacing alone; slope and
///       intercept apply. Analyze 7.5 (.hdr and .img): spacing alone, for it says nothing else reliably.
///   DICOM, a folder, one of its files or frames in one: by GDCM, all of it in memory. Position, orientation, spacing,
///       rescale; the slices of one series by their places. Uneven ones are a rectilinear grid.
///   NetCDF and HDF5 of three dimensions in space, VTKHDF images, MINC 1 and 2, XDMF of one regular or rectilinear
///   grid:
///       by their libraries, all of it in memory. Whether NetCDF, HDF5 and XDMF files are volumes, they tell.
///   .raw: described by the options or by its name, in place. .bricks: what write_bricks made, read brick by brick.
///   A gzip file of any of these is inflated into memory first, whatever its name.
///
/// In memory: samples that have to be unpacked and take more than half of ReadOptions::memory_bytes go into a file of
/// bricks without a name (system/scratch_file.hpp) as they come, where the format lets them come in parts: gzip, an
/// array of .vti or .vtr, what a helper holds. Without room for that they stay in memory.
/// World coordinates are the file's own (NIfTI's point right, anterior, up, DICOM's left,
/// back, up; MetaImage's and NRRD's whatever they say).
/// Headers are compared with the file's size before memory is asked for. Throws Error(bad_input) in one line for a
/// missing, truncated, malformed or flat file, for more dimensions than three, time and components, for an encoding or
/// type not known, for an unknown field or time step, or if no sample is finite.
VolumeFile open_volume(const InputFile& file, const ReadOptions& options = {});

/// The same without its range and what follows from that, for those who scan the samples themselves and then call
/// set_range(). Vectors of which a component is chosen are read nevertheless: they are listed by their lengths.
/// `scratch_is_needed`: other processes read what is unpacked, so that it goes into a file whatever it takes.
VolumeFile open_unscanned_volume(const InputFile& file, const ReadOptions& options = {},
                                 bool scratch_is_needed = false);

/// Enters the range of all samples, and what follows from it into fields and notes. Throws Error(bad_input) if none is
/// finite.
void set_range(VolumeFile& volume, const std::filesystem::path& file, const scene::ValueRange& range);

/// Name of a type on the command line and in .raw names: uint8, int16, float32, ... (float and double too).
std::optional<scene::SampleType> parse_sample_type(const std::string& text);

}  // namespace tessera::io
