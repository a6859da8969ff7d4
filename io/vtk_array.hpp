#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "io/streamed_bricks.hpp"

namespace tessera::io {

class PositionalFile;

/// Where an array of a VTK XML file begins, and how it is packed there.
///
/// raw         u32 or u64 number of bytes, bytes
/// base64      the same as text, four characters for three bytes; padding (=) may end the text of the number and that
///             of the bytes
/// compressed  as u32 or u64: n blocks, bytes of one, bytes of the last if it is shorter, else 0, packed bytes of each;
///             then the blocks, each a zlib stream. In base64 the numbers are a text by themselves.
///
/// Source: VTK File Formats, "XML File Formats", and what its writers write (vtkXMLWriter.cxx).
struct VtkArrayPlace {
  std::uint64_t first_byte = 0;
  bool base64 = false, compressed = false;
  bool swapped = false;       ///< its numbers, and the array's, are of the other byte order than this machine's
  unsigned number_bytes = 4;  ///< 8: u64
};

/// Where an array of `count` bytes ends, or some blanks and padding before that if it is text. None if what it says of
/// itself is not of so many bytes, or of more than the file has.
std::optional<std::uint64_t> end_of_vtk_array(const PositionalFile& file, const VtkArrayPlace& place,
                                              std::uint64_t count);

/// All of an array that is small. None if it has not `count` bytes or is damaged.
std::optional<std::vector<std::byte>> small_vtk_array(const PositionalFile& file, const VtkArrayPlace& place,
                                                      std::uint64_t count);

/// Gives `use` all `count` bytes of the array in parts. Throws Error(bad_input) of `source` if they are damaged or end
/// before.
void read_vtk_array(const std::filesystem::path& file, const VtkArrayPlace& place, std::uint64_t count,
                    const std::string& source, const ByteSink& use);

}  // namespace tessera::io
