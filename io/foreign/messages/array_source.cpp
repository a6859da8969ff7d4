// SPDX-License-Identifier: BSD-3-Clause
#include "io/foreign/messages/array_source.hpp"

#include "system/large_vector.hpp"

namespace tessera::io {

std::vector<std::byte> ArraySource::copy(const ForeignArray& array, const std::string& subject, Then then) {
  std::vector<std::byte> all;
  system::reserve_large(all, array.bytes());
  stream(
      array, subject, [&](std::span<const std::byte> tuples) { all.insert(all.end(), tuples.begin(), tuples.end()); },
      then);
  return all;
}

}  // namespace tessera::io
