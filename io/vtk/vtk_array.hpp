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

/// Location and encoding of a binary array of a VTK XML file.
///
/// raw         the number of bytes as u32 or u64, then the bytes
/// base64      the same as text, four characters for three bytes; padding (=) may end both the text of the number and
///             the text of the bytes
/// compressed  as u32 or u64: the number of blocks, the size of a block, the size of the last block if it is smaller
///             (otherwise 0), and the packed size of each block; then the blocks (VtkCodec). In base64, these numbers
///             are a separate text.
///
/// Source: VTK File Formats, "XML File Formats", and the output of VTK's writers (vtkXMLWriter.cxx).
struct VtkArrayPlace {
  std::uint64_t first_byte = 0;
  std::uint64_t end = std::numeric_limits<std::uint64_t>::max();  ///< the array ends before this position
  bool base64 = false;
  VtkCodec codec = VtkCodec::none;
  bool swapped = false;       ///< the byte order of the array and its counts is not native
  unsigned number_bytes = 4;  ///< 8: u64
};

/// Reads the bytes of a binary array sequentially and unpacks them. Blocks that are read completely are unpacked on
/// several threads.
class VtkArrayBytes {
 public:
  /// Opens an array. No value if the array's own counts are impossible for this file; no memory is allocated for an
  /// array of this kind.
  static std::optional<VtkArrayBytes> open(const system::PositionalFile& file, const VtkArrayPlace& place);

  /// Size of the whole array.
  [[nodiscard]] std::uint64_t size() const { return size_; }
  /// Unpacked size of a block; 0: the array is not divided into blocks.
  [[nodiscard]] std::uint64_t block_size() const { return block_size_; }
  /// Position and stored size of the array's bytes in the file, not counting blanks in text.
  [[nodiscard]] std::uint64_t position() const { return packed_.position(); }
  [[nodiscard]] std::uint64_t packed_size() const { return packed_size_; }

  /// Reads the next `count` bytes; all calls together may read at most size() bytes. Returns false if the bytes are
  /// damaged.
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
  std::vector<std::byte> block_;  ///< a block that was only partly read
  std::size_t block_at_ = 0;
};

/// Returns where an array of `count` bytes ends; for text, the end may be before some blanks and padding. No value if
/// the array's own counts do not match `count`, exceed the file, or include blocks too large to be read a part at a
/// time.
std::optional<std::uint64_t> end_of_vtk_array(const system::PositionalFile& file, const VtkArrayPlace& place,
                                              std::uint64_t count);

/// Returns all bytes of a small array. No value if the size of the array is not `count` or if it is damaged.
std::optional<std::vector<std::byte>> small_vtk_array(const system::PositionalFile& file, const VtkArrayPlace& place,
                                                      std::uint64_t count);

/// Passes all `count` bytes of the array to `use`, in parts. Throws Error(bad_input) naming `source` if the bytes are
/// damaged or too few.
void read_vtk_array(const std::filesystem::path& file, const VtkArrayPlace& place, std::uint64_t count,
                    const std::string& source, const system::ByteSink& use);

}  // namespace tessera::io
