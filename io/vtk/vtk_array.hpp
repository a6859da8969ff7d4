// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "io/text/base64_text.hpp"
#include "io/vtk/vtk_codec.hpp"
#include "system/byte_sink.hpp"

namespace tessera::system {
class PositionalFile;
}

namespace tessera::io {

/// Where a binary array of a VTK XML file begins, and how it is packed there.
///
/// raw         u32 or u64 number of bytes, bytes
/// base64      the same as text, four characters for three bytes; padding (=) may end the text of the number and that
///             of the bytes
/// compressed  as u32 or u64: n blocks, bytes of one, bytes of the last if it is shorter, else 0, packed bytes of each;
///             then the blocks (VtkCodec). In base64 the numbers are a text by themselves.
///
/// Source: VTK File Formats, "XML File Formats", and what its writers write (vtkXMLWriter.cxx).
struct VtkArrayPlace {
  std::uint64_t first_byte = 0;
  std::uint64_t end = std::numeric_limits<std::uint64_t>::max();  ///< the array ends before it
  bool base64 = false;
  VtkCodec codec = VtkCodec::none;
  bool swapped = false;       ///< its numbers, and the array's, are of the other byte order than this machine's
  unsigned number_bytes = 4;  ///< 8: u64
};

/// The bytes of a binary array in their order, as they are stored but unpacked. Blocks that are wanted whole are
/// unpacked on several threads.
class VtkArrayBytes {
 public:
  /// Nothing if what the array states of itself cannot be true of this file. Such an array takes no memory.
  static std::optional<VtkArrayBytes> open(const system::PositionalFile& file, const VtkArrayPlace& place);

  /// Of the whole array.
  [[nodiscard]] std::uint64_t size() const { return size_; }
  /// Bytes of a block when unpacked; 0: it has no blocks.
  [[nodiscard]] std::uint64_t block_size() const { return block_size_; }
  /// Where the array's bytes begin and how many they are in the file, not counting blanks in text.
  [[nodiscard]] std::uint64_t position() const { return packed_.position(); }
  [[nodiscard]] std::uint64_t packed_size() const { return packed_size_; }

  /// The next `count` bytes, at most size() in all; false: they are damaged.
  [[nodiscard]] bool read(std::byte* to, std::uint64_t count);

 private:
  VtkArrayBytes(const system::PositionalFile& file, const VtkArrayPlace& place);
  [[nodiscard]] bool read_number(std::uint64_t& number);
  [[nodiscard]] bool read_table(std::uint64_t file_bytes);
  [[nodiscard]] std::uint64_t size_of_block(std::size_t block) const;
  [[nodiscard]] bool unpack(std::size_t blocks, std::byte* to);

  VtkArrayPlace place_;
  PackedBytes packed_;
  std::uint64_t size_ = 0, packed_size_ = 0, block_size_ = 0, last_size_ = 0;
  std::vector<std::uint64_t> packed_blocks_;
  std::size_t next_ = 0;          ///< block
  std::vector<std::byte> block_;  ///< one that is read in part
  std::size_t block_at_ = 0;
};

/// Where an array of `count` bytes ends, or some blanks and padding before that if it is text. None if what it states
/// of itself is not of so many bytes, or of more than the file has, or of blocks too large to be read a part at a time.
std::optional<std::uint64_t> end_of_vtk_array(const system::PositionalFile& file, const VtkArrayPlace& place,
                                              std::uint64_t count);

/// All of an array that is small. None if it has not `count` bytes or is damaged.
std::optional<std::vector<std::byte>> small_vtk_array(const system::PositionalFile& file, const VtkArrayPlace& place,
                                                      std::uint64_t count);

/// Passes all `count` bytes of the array to `use` in parts. Throws Error(bad_input) of `source` if they are damaged or
/// end before.
void read_vtk_array(const std::filesystem::path& file, const VtkArrayPlace& place, std::uint64_t count,
                    const std::string& source, const system::ByteSink& use);

}  // namespace tessera::io
