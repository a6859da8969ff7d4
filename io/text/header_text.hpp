// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string_view>
#include <vector>

#include "scene/grid.hpp"

/// Numbers in the text headers of volumes (MetaImage, NRRD). All throw Error(bad_input, "FILE: WHAT is ...").
namespace tessera::io {

/// Exactly `count` numbers between blanks, commas or brackets; "nan" is one.
std::vector<double> header_numbers(std::string_view text, std::size_t count, const std::filesystem::path& file,
                                   const char* what);

/// One whole number in [low, high].
std::int64_t header_count(std::string_view text, std::int64_t low, std::int64_t high, const std::filesystem::path& file,
                          const char* what);

/// Whole numbers above 0, below 2^40, as many as there are.
std::vector<std::int64_t> header_count_list(std::string_view text, const std::filesystem::path& file, const char* what);

/// Exactly three of them.
scene::GridIndex header_counts(std::string_view text, const std::filesystem::path& file, const char* what);

/// The file of samples that a header names, beside it or by an absolute path. It is there.
std::filesystem::path header_path(std::string_view text, const std::filesystem::path& file, const char* what);

/// The files of a volume's slices: of "LIST", whose names follow one a line in `lines`; of "PATTERN FIRST LAST [STEP]",
/// with one %d or %03d for the number. Empty if the text names one file. Words after LIST, and a last number after the
/// step, say the dimensions of a file, which its part of the samples says as well. At most `most`, which are there.
std::vector<std::filesystem::path> header_slices(std::string_view text, std::string_view lines, std::uint64_t most,
                                                 const std::filesystem::path& file, const char* what);

}  // namespace tessera::io
