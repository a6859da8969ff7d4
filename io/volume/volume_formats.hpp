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

/// What a header says of one array of samples and of where its bytes are.
struct StoredVolume {
  scene::Grid grid;  ///< geometry, scale, shift; type and name follow from the choice of a component
  scene::SampleType number = scene::SampleType::uint8;  ///< of each component
  int components = 1;
  bool planar = false;                        ///< all samples of a component together, not all components of a sample
  std::uint64_t steps = 1;                    ///< volumes in the payload, one after the other
  std::vector<double> times{};                ///< of all steps, where the header states them; else none
  bool interleaved_steps = false;             ///< instead, a sample of each step together; one component
  bool swapped = false;                       ///< bytes are of the other order than this machine's
  std::filesystem::path payload;              ///< the file itself, or another
  std::uint64_t payload_size = 0;             ///< of the file itself; of another 0
  std::vector<std::filesystem::path> slices;  ///< instead of one payload: files of equal parts of it, in order
  std::uint64_t offset = 0;                   ///< of the payload in it, or of its part in each of them
  bool at_end = false;                        ///< instead of an offset: the payload ends with the file
  bool exact_size = false;                    ///< the file must end with the payload
  bool compressed = false;  ///< gzip or zlib from `offset` on; with `compressed_whole` from the beginning
  bool compressed_whole = false;
  std::optional<VtkArrayPlace> vtk_array{};  ///< instead of an offset: a packed array of a VTK XML file
  std::uint64_t skip_inflated = 0;           ///< compressed: bytes before the samples in what comes out
  enum class Coding { binary, text, hex } coding = Coding::binary;
  enum class Wide { no, int64, uint64 } wide = Wide::no;  ///< 64-bit integers; `number` is float64, which they become

  /// Of each component, `number` and `wide`.
  void set_type(scene::NumberType type) {
    number = scene::sample_type_of(type).value_or(scene::SampleType::float64);
    wide = type == scene::NumberType::int64 ? Wide::int64 : type == scene::NumberType::uint64 ? Wide::uint64 : Wide::no;
  }

  std::string field = "samples";
  bool active = false;               ///< the file marks it as its scalars
  std::optional<bool> has_colors{};  ///< what the file says of its components; else look_like_colors() decides
  std::string format;
  std::vector<std::string> notes;
  BodyAxes body_axes = BodyAxes::none;
  BodyAxes axes_if_ct = BodyAxes::none;  ///< as VolumeFile::axes_if_ct
  VolumeTags tags{};
};

/// Fields, choice and source of one array of samples.
VolumeFile open_stored(StoredVolume volume, const VolumeOptions& options, const std::string& source);

/// Throws Error(bad_input) of a file that is of its format by its name alone.
void require_recognized(const InputFile& file);

VolumeFile with_tag_note(VolumeFile volume);

/// Where a gzip file's samples end by its header; no value if that does not tell.
std::optional<std::uint64_t> end_in_gzip(const StoredVolume& volume, const InputFile& file);

/// A .raw file by the options or by its name; the payload is left to be set.
StoredVolume describe_raw(const std::filesystem::path& file, const ReadOptions& options);

// What the rows of the table of formats (io/formats/format_table.cpp) name of this directory.
VolumeFile open_nifti(const InputFile& file, const VolumeOptions& options);
/// An Analyze 7.5 header, or the .img beside one.
VolumeFile open_analyze(const InputFile& file, const VolumeOptions& options);
VolumeFile open_nrrd(const InputFile& file, const VolumeOptions& options);
std::optional<std::uint64_t> end_of_nrrd(const InputFile& file);
VolumeFile open_meta_image(const InputFile& file, const VolumeOptions& options);
std::optional<std::uint64_t> end_of_meta_image(const InputFile& file);
VolumeFile open_brick_file(const InputFile& file, const VolumeOptions& options);
VolumeFile open_raw(const InputFile& file, const VolumeOptions& options);

}  // namespace tessera::io
