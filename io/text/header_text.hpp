// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string_view>
#include <vector>

#include "scene/grid.hpp"

/// Numbers in the text headers of volumes (MetaImage, NRRD). All functions throw Error(bad_input, "FILE: WHAT is ...").
namespace tessera::io {

/// Exactly `count` numbers separated by blanks, commas or brackets; "nan" is a number.
std::vector<double> header_numbers(std::string_view text, std::size_t count, const std::filesystem::path& file,
                                   const char* what);

/// One integer in [low, high].
std::int64_t header_count(std::string_view text, std::int64_t low, std::int64_t high, const std::filesystem::path& file,
                          const char* what);

/// All integers of the text, each above 0 and below 2^40.
std::vector<std::int64_t> header_count_list(std::string_view text, const std::filesystem::path& file, const char* what);

/// Exactly three such integers.
scene::GridIndex header_counts(std::string_view text, const std::filesystem::path& file, const char* what);

/// The file of samples named by a header, relative to it or absolute. It exists.
std::filesystem::path header_path(std::string_view text, const std::filesystem::path& file, const char* what);

/// The files of a volume's slices: for "LIST", the names in `lines`, one per line; for "PATTERN FIRST LAST [STEP]", the
/// pattern with one %d or %03d for the number. Empty if the text names one file. A word after LIST, and a last number
/// after the step, is the dimension of a file; it is ignored, because the file's share of the samples determines it
/// too. At most `most` files, which all exist.
std::vector<std::filesystem::path> header_slices(std::string_view text, std::string_view lines, std::uint64_t most,
                                                 const std::filesystem::path& file, const char* what);

}  // namespace tessera::io
