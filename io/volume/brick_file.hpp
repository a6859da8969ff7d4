// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <string_view>

#include "io/volume/streamed_bricks.hpp"
#include "io/volume/volume_options.hpp"
#include "io/volume/volume_reader.hpp"
#include "scene/sample_source.hpp"
#include "system/scratch_file.hpp"

namespace tessera::io {

/// A brick file (.bricks): a volume cut into contiguous blocks, each stored with the range of its values, so that a
/// volume larger than memory is read on demand and invisible blocks are never read.
///
///   bytes 0..7     "TESSBRK1"
///   bytes 8..15    uint64 length H of the header
///   bytes 16..     H bytes of JSON, padded with blanks: points [3], association, origin [3], direction [9, column by
///                  column], spacing [3], coordinates [3 lists, empty where regular], type, scale, shift, field, block
///                  (a side, in samples), low, high, blanks (of all values); if stated, the entries of tag_words()
///                  (volume_tags.hpp): space, modality, unit, length unit, intent
///   then           for each block, i fastest: float64 low, float64 high, uint64 blanks (24 bytes)
///   then           the samples of each block in the same order, i fastest in it, without padding; blocks at the upper
///                  boundary are smaller
/// Everything is little endian. No sample is stored twice: a brick with a border reads from up to 27 blocks.
///
/// `name` is used in the messages of later reads; empty: the file's name.
VolumeFile open_bricks(const std::filesystem::path& file, const ReadOptions& options, const std::string& name = {});

/// Writes a brick file with blocks of `side` samples (8 to 1024) along each axis. Reads `source` once, one row of
/// blocks at a time, on the threads of the caller's arena. The file appears by rename. Throws Error(bad_input) for a
/// side out of range, Error(system_failure) if writing fails.
void write_bricks(const scene::SampleSource& source, const std::filesystem::path& file, int side = 64,
                  BodyAxes axes = BodyAxes::none, const VolumeTags& tags = {});

/// Writes a brick file as a scratch file of this process that other processes can open (system/scratch_file.hpp) with
/// open_bricks(). Throws Error(bad_input) naming `subject` if there is no space for the file.
std::unique_ptr<system::ScratchFile> scratch_bricks(const scene::SampleSource& source, const std::string& subject);

/// Unpacks samples, a part at a time, into a scratch brick file and opens the file: sets the volume's source and
/// scratch. Returns false without doing anything if the samples may stay in memory according to VolumeOptions, or if
/// there is no space for the file and `options` does not make that an error.
bool unpacked_to_scratch(const StreamedSamples& samples, const VolumeOptions& options, const std::string& source,
                         VolumeFile& volume);

}  // namespace tessera::io
