// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string_view>
#include <vector>

#include "scene/grid.hpp"

/// Parsers of numbers in the text headers of volumes (MetaImage, NRRD). All functions throw Error(bad_input, "FILE:
/// WHAT is ...").
namespace tessera::io {

/// Parses exactly `count` numbers separated by blanks, commas or brackets; "nan" is a number.
std::vector<double> header_numbers(std::string_view text, std::size_t count, const std::filesystem::path& file,
                                   const char* what);

/// Parses one integer in [low, high].
std::int64_t header_count(std::string_view text, std::int64_t low, std::int64_t high, const std::filesystem::path& file,
                          const char* what);

/// Parses all integers of the text, each greater than 0 and less than 2^40.
std::vector<std::int64_t> header_count_list(std::string_view text, const std::filesystem::path& file, const char* what);

/// Parses exactly three integers, each greater than 0 and less than 2^40.
scene::GridIndex header_counts(std::string_view text, const std::filesystem::path& file, const char* what);

/// Returns the file of samples that a header names, by an absolute path or relative to the header. Throws if the file
/// does not exist.
std::filesystem::path header_path(std::string_view text, const std::filesystem::path& file, const char* what);

/// Returns the files of a volume's slices. For the text "LIST" these are the names in `lines`, one per line; for
/// "PATTERN FIRST LAST [STEP]", the pattern has one %d or %03d for the number. Empty if the text names one file. A word
/// after LIST, or a number after the step, states the dimension of each file; it is ignored, because the file's share
/// of the samples determines the dimension, too. Returns at most `most` files, and throws if one does not exist.
std::vector<std::filesystem::path> header_slices(std::string_view text, std::string_view lines, std::uint64_t most,
                                                 const std::filesystem::path& file, const char* what);

}  // namespace tessera::io
