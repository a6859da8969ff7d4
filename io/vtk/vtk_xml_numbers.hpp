// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "io/vtk/vtk_text_numbers.hpp"
#include "io/vtk/vtk_xml_grid.hpp"
#include "system/byte_sink.hpp"

namespace tessera::io {

/// The first numbers of an array, which a piece of a file uses. The remaining numbers of longer arrays are ignored, as
/// in VTK.
struct VtkXmlSegment {
  VtkXmlArray array;
  std::uint64_t numbers = 0;
};

/// Throws Error(bad_input) naming `source` if an array has fewer numbers than its segment, as far as this can be
/// determined without unpacking. Must be called before memory is allocated for the numbers.
void require_numbers(const system::PositionalFile& file, const VtkXmlSegment& segment, const std::string& source);

/// Passes the numbers of a segment to `use` in order, in native byte order, in multiples of `together` numbers. Throws
/// Error(bad_input) naming `source` if the numbers are damaged or too few.
void stream_numbers(const system::PositionalFile& file, const VtkXmlSegment& segment, std::size_t together,
                    const std::string& source, const system::ByteSink& use);

/// Passes integers of any type, converted to int64, like stream_numbers(). Unsigned integers beyond int64's range
/// become negative.
void stream_whole_numbers(const system::PositionalFile& file, const VtkXmlSegment& segment, std::size_t together,
                          const std::string& source, const std::function<void(std::span<const std::int64_t>)>& use);

/// Returns all integers of a segment.
std::vector<std::int64_t> whole_numbers(const system::PositionalFile& file, const VtkXmlSegment& segment,
                                        const std::string& source);

}  // namespace tessera::io
