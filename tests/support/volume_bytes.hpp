// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

/// Small volume files as bytes, and conversion of numbers to bytes for others.
namespace tessera::test {

template <class T>
void put(std::string& bytes, std::size_t at, T value) {
  std::memcpy(bytes.data() + at, &value, sizeof value);
}

template <class T>
std::string bytes_of(const std::vector<T>& values) {
  std::string bytes(values.size() * sizeof(T), '\0');
  if (!values.empty()) std::memcpy(bytes.data(), values.data(), bytes.size());
  return bytes;
}

/// 0, 1, 2, ...
template <class T>
std::vector<T> counting(std::size_t count) {
  std::vector<T> values(count);
  for (std::size_t i = 0; i < count; ++i) values[i] = static_cast<T>(i);
  return values;
}

/// A NIfTI-1 header of 4 x 3 x 2 int16 samples with spacing 1, 2, 3, without qform and sform. It includes the 4 bytes
/// that state that there is no extension.
inline std::string nifti_header() {
  std::string h(352, '\0');
  put<std::int32_t>(h, 0, 348);
  const std::int16_t dim[] = {3, 4, 3, 2, 1, 1, 1, 1};
  std::memcpy(h.data() + 40, dim, sizeof dim);
  put<std::int16_t>(h, 70, 4);   // int16
  put<std::int16_t>(h, 72, 16);  // bits
  const float pixdim[] = {1, 1, 2, 3};
  std::memcpy(h.data() + 76, pixdim, sizeof pixdim);
  put<float>(h, 108, 352);  // vox_offset
  std::memcpy(h.data() + 344, "n+1", 4);
  return h;
}

inline std::string nifti() { return nifti_header() + bytes_of(counting<std::int16_t>(24)); }

}  // namespace tessera::test
