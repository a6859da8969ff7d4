// SPDX-License-Identifier: BSD-3-Clause
// The filter lzf of HDF5 files. Its stream: Marc Lehmann, LibLZF, lzf_d.c; its parameters: h5py, lzf_filter.c.
#include "readers/vtk/hdf5/hdf5_lzf.hpp"

#include <hdf5.h>

#include <algorithm>
#include <cstdlib>
#include <optional>
#include <span>

namespace tessera::readers {
namespace {

constexpr H5Z_filter_t lzf_number = 32000;

/// Returns the number of bytes to which `packed` inflates; no value if they do not fit into `out`, or if `packed` is
/// damaged.
std::optional<std::size_t> inflate_lzf(std::span<const unsigned char> packed, std::span<unsigned char> out) {
  std::size_t in = 0, done = 0;
  while (in < packed.size()) {
    const std::size_t control = packed[in++];
    if (control < 32) {  // a run of control + 1 literal bytes
      const std::size_t count = control + 1;
      if (count > packed.size() - in || count > out.size() - done) return std::nullopt;
      std::copy_n(packed.begin() + static_cast<std::ptrdiff_t>(in), count,
                  out.begin() + static_cast<std::ptrdiff_t>(done));
      in += count, done += count;
      continue;
    }
    std::size_t count = control >> 5;
    if (count == 7) {
      if (in >= packed.size()) return std::nullopt;
      count += packed[in++];
    }
    count += 2;
    if (in >= packed.size()) return std::nullopt;
    const std::size_t back = ((control & 31) << 8 | packed[in++]) + 1;
    if (back > done || count > out.size() - done) return std::nullopt;
    for (std::size_t k = 0; k < count; ++k, ++done) out[done] = out[done - back];  // source and destination may overlap
  }
  return done;
}

/// An H5Z_func_t, which returns 0 for a failure. The third parameter is the size of a chunk in bytes.
std::size_t undo_lzf(unsigned flags, std::size_t parameters, const unsigned* parameter, std::size_t bytes,
                     std::size_t* size, void** buffer) {
  if ((flags & H5Z_FLAG_REVERSE) == 0) return 0;
  constexpr std::size_t most = std::size_t{1} << 32;  // HDF5's limit of the size of a chunk
  std::size_t room = parameters > 2 && parameter[2] != 0 ? parameter[2] : *size;
  for (; room <= most; room *= 2) {
    void* const out = std::malloc(room);
    if (out == nullptr) return 0;
    const auto done =
        inflate_lzf({static_cast<const unsigned char*>(*buffer), bytes}, {static_cast<unsigned char*>(out), room});
    if (done && *done > 0) {
      std::free(*buffer);
      *buffer = out;
      *size = room;
      return *done;
    }
    std::free(out);
    if (bytes == 0 || room / bytes > 300) return 0;  // three bytes inflate to at most 264 bytes
  }
  return 0;
}

}  // namespace

void register_lzf() {
  if (H5Zfilter_avail(lzf_number) > 0) return;
  const H5Z_class2_t lzf{H5Z_CLASS_T_VERS, lzf_number, 0, 1, "lzf", nullptr, nullptr, undo_lzf};
  H5Zregister(&lzf);
}

}  // namespace tessera::readers
