#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include "io/streamed_bricks.hpp"

namespace tessera::io {

struct StoredVolume;

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

/// What is said here of a .vti of one piece with one array whose samples take more than `most_in_memory` bytes, and
/// that are raw, base64 or zlib: so that they can be read where they lie, or in their order a part at a time. None of
/// any other file, nor of one in which anything is odd: that is VTK's to read, and to find fault with.
std::optional<StoredVolume> read_plain_vti(const std::filesystem::path& file, std::uint64_t most_in_memory);

/// Gives `use` all `count` bytes of the array in parts. Throws Error(bad_input) of `source` if they are damaged or end
/// before.
void read_vtk_array(const std::filesystem::path& file, const VtkArrayPlace& place, std::uint64_t count,
                    const std::string& source, const ByteSink& use);

}  // namespace tessera::io
