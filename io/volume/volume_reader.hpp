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

/// A volume whose samples stay in the file or, if they had to be decompressed, in memory or a scratch file.
struct VolumeFile {
  std::unique_ptr<scene::SampleSource> source;
  std::shared_ptr<const system::ScratchFile>
      scratch;                              ///< unpacked samples that other processes can read, too; otherwise null
  bool in_memory = true;                    ///< all samples are in memory because they were unpacked or combined
  scene::ValueRange range;                  ///< range and blanks of the chosen field; empty until set_range()
  std::vector<cells::FieldSummary> fields;  ///< fields of the file; low > high: the range is unknown until set_range()
  std::vector<std::string> notes;           ///< one line each: what was chosen or applied, or is unusual
  std::string format;
  BodyAxes body_axes = BodyAxes::none;
  BodyAxes axes_if_ct = BodyAxes::none;  ///< becomes body_axes in set_range() if the values look like those of CT
  VolumeTags tags{};
  scene::TimeStepRead time_step{};
  bool xy_in_degrees = false;  ///< x and y are degrees, z is a length
};

/// Whether the file is a regular or rectilinear grid, or .raw. For NetCDF, HDF5 and XDMF files a helper inspects the
/// content, which takes some hundredths of a second.
bool is_volume(const InputFile& file);

/// Throws Error(bad_input) for a mesh. Does not read samples.
void require_volume(const InputFile& file);

/// Opens a volume.
///
///   .vti .pvti .vtr .pvtr, .vtk of structured points or a rectilinear grid: by VTK, all of it in memory (a large .vti
///       or .vtr of one array: plain_vtk_grid.hpp). Extent, origin, spacing and direction apply; pieces must fill the
///       whole extent and agree on its coordinates. A curvilinear .vtk is a mesh. 64-bit integers become doubles.
///       Hidden samples are blank.
///   .mhd .mha: origin, spacing, orientation, slope and offset apply; raw (in place), compressed or text.
///   .nrrd .nhdr: space origin and directions, else axis minimums and spacings; raw (in place), gzip, ascii or hex. A
///       first axis of components is allowed; "old min" and the measurement frame are ignored. Slices in several files
///       (LIST, NAME%03d), here and for MetaImage, are combined in memory.
///   .nii .nii.gz (NIfTI-1 and 2), or in two files .hdr and .img: sform, else qform, else only the spacing; slope and
///       intercept apply. Analyze 7.5 (.hdr and .img): only the spacing, because nothing else in it is reliable.
///   DICOM, a directory, one of its files or frames in one: by GDCM, all of it in memory. Position, orientation,
///       spacing and rescale apply; the slices of one series are sorted by position. Non-uniform slices become a
///       rectilinear grid.
///   NetCDF and HDF5 of three dimensions in space, VTKHDF images, MINC 1 and 2, XDMF of one regular or rectilinear
///       grid: by their libraries, all of it in memory. The libraries determine whether a file is a volume.
///   .raw: described by the options or by its name, in place. .bricks: files of write_bricks, read brick by brick.
///   A gzip file of any of these is inflated into memory first, whatever its name.
///
/// In memory: samples that must be unpacked and take more than half of ReadOptions::memory_bytes go into a brick file
/// without a name (system/scratch_file.hpp) as they are read, if the format provides them in parts: gzip, an array of
/// .vti or .vtr, arrays held by a helper. If the disk has no space for the brick file, the samples stay in memory.
/// World coordinates are the file's own (NIfTI's axes point right, anterior, up, DICOM's left, back, up; MetaImage's
/// and NRRD's as stated in the file).
/// Headers are compared with the file's size before memory is allocated. Throws Error(bad_input) in one line for a
/// missing, truncated, malformed or flat file, for dimensions beyond three in space, time and components, for an
/// unknown encoding, type, field or time step, or if no sample is finite.
VolumeFile open_volume(const InputFile& file, const ReadOptions& options = {});

/// Opens a volume without computing its range and everything that depends on the range, for callers that scan the
/// samples themselves and then call set_range(). If one component of vectors is chosen, the samples are read
/// nevertheless, because fields of vectors are listed with the range of the vectors' lengths. `scratch_is_needed`:
/// other processes read the unpacked samples, so these are written to a scratch file whatever their size.
VolumeFile open_unscanned_volume(const InputFile& file, const ReadOptions& options = {},
                                 bool scratch_is_needed = false);

/// Stores the range of all samples, and derives fields and notes from it. Throws Error(bad_input) if no sample is
/// finite.
void set_range(VolumeFile& volume, const std::filesystem::path& file, const scene::ValueRange& range);

/// Parses the name of a type as used on the command line and in names of .raw files: uint8, int16, float32, ... (also
/// float and double).
std::optional<scene::SampleType> parse_sample_type(const std::string& text);

}  // namespace tessera::io
