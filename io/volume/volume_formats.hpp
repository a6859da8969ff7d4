// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "io/files/input_file.hpp"
#include "io/text/clean_errors.hpp"
#include "io/volume/volume_reader.hpp"
#include "io/vtk/vtk_array.hpp"
#include "scene/number_type.hpp"

namespace tessera::io {

/// Description of one array of samples: its type and the location of its bytes.
struct StoredVolume {
  scene::Grid grid;  ///< geometry, scale, shift; type and name depend on the component that is chosen later
  scene::SampleType number = scene::SampleType::uint8;  ///< type of each component
  int components = 1;
  bool planar = false;                        ///< components are stored one after the other, not interleaved
  std::uint64_t steps = 1;                    ///< number of volumes in the payload, one after the other
  std::vector<double> times{};                ///< times of all steps, if the header states them; otherwise empty
  bool interleaved_steps = false;             ///< the steps of each sample are adjacent; there is one component
  bool swapped = false;                       ///< the byte order is not native
  std::filesystem::path payload;              ///< file that contains the samples: the opened file or another one
  std::uint64_t payload_size = 0;             ///< size in bytes of the payload if it is the opened file; else 0
  std::vector<std::filesystem::path> slices;  ///< instead of one payload file: files with equal shares, in order
  std::uint64_t offset = 0;                   ///< position of the payload in the file, or of each share in its file
  bool at_end = false;                        ///< instead of an offset: the payload is at the end of the file
  bool exact_size = false;                    ///< the file must end with the payload
  bool compressed = false;  ///< gzip or zlib from `offset` on, or with `compressed_whole` from the start of the file
  bool compressed_whole = false;
  std::optional<VtkArrayPlace> vtk_array{};  ///< instead of an offset: a packed array of a VTK XML file
  std::uint64_t skip_inflated = 0;           ///< if compressed: number of inflated bytes before the samples
  enum class Coding { binary, text, hex } coding = Coding::binary;
  enum class Wide {
    no,
    int64,
    uint64
  } wide = Wide::no;  ///< the file has 64-bit integers; `number` is float64, to which they are converted

  /// Sets `number` and `wide` according to the file's type.
  void set_type(scene::NumberType type) {
    number = scene::sample_type_of(type).value_or(scene::SampleType::float64);
    wide = type == scene::NumberType::int64 ? Wide::int64 : type == scene::NumberType::uint64 ? Wide::uint64 : Wide::no;
  }

  std::string field = "samples";
  bool active = false;               ///< the file marks the array as its scalars
  std::optional<bool> has_colors{};  ///< as stated in the file; no value: look_like_colors() decides
  std::string format;
  std::vector<std::string> notes;
  BodyAxes body_axes = BodyAxes::none;
  BodyAxes axes_if_ct = BodyAxes::none;  ///< see VolumeFile::axes_if_ct
  VolumeTags tags{};
};

/// Opens one array of samples: determines its fields, the chosen field, and the source.
VolumeFile open_stored(StoredVolume volume, const VolumeOptions& options, const std::string& source);

/// Throws Error(bad_input) if only the name of a file, not its first bytes, identifies the format.
void require_recognized(const InputFile& file);

VolumeFile with_tag_note(VolumeFile volume);

/// Returns where the samples of a gzip file end according to the header; no value if the header does not determine it.
std::optional<std::uint64_t> end_in_gzip(const StoredVolume& volume, const InputFile& file);

/// Describes a .raw file according to the options or the file's name; the caller sets the payload.
StoredVolume describe_raw(const std::filesystem::path& file, const ReadOptions& options);

// Readers of volume files, named by rows of the table of formats (io/formats/format_table.cpp).
VolumeFile open_nifti(const InputFile& file, const VolumeOptions& options);
/// Opens an Analyze 7.5 file, given the header or the .img that belongs to it.
VolumeFile open_analyze(const InputFile& file, const VolumeOptions& options);
VolumeFile open_nrrd(const InputFile& file, const VolumeOptions& options);
std::optional<std::uint64_t> end_of_nrrd(const InputFile& file);
VolumeFile open_meta_image(const InputFile& file, const VolumeOptions& options);
std::optional<std::uint64_t> end_of_meta_image(const InputFile& file);
VolumeFile open_brick_file(const InputFile& file, const VolumeOptions& options);
VolumeFile open_raw(const InputFile& file, const VolumeOptions& options);

}  // namespace tessera::io
