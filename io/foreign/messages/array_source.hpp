// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "io/foreign/messages/foreign_data.hpp"

namespace tessera::io {

/// Supplies the arrays of an opened file (ForeignContents), which are identified by number. The source is either the
/// reader program that stores the arrays (HelperProcess) or this process, which reads them from the file
/// (VtkXmlArrays).
class ArraySource {
 public:
  ArraySource() = default;
  virtual ~ArraySource() = default;
  ArraySource(const ArraySource&) = delete;
  ArraySource& operator=(const ArraySource&) = delete;

  enum class Then : std::uint8_t { dropped, kept };

  /// Passes all tuples of an array to `use`, in order, in runs of whole tuples. `use` must copy the bytes before it
  /// examines them, because another process may change them. The array can be read again later only if `then` is
  /// Then::kept. Throws Error(bad_input) with a message that begins with `subject`.
  virtual void stream(const ForeignArray& array, const std::string& subject,
                      const std::function<void(std::span<const std::byte> tuples)>& use, Then then) = 0;
  void stream(const ForeignArray& array, const std::string& subject,
              const std::function<void(std::span<const std::byte> tuples)>& use) {
    stream(array, subject, use, Then::dropped);
  }

  /// Returns all bytes of an array, read by stream().
  std::vector<std::byte> copy(const ForeignArray& array, const std::string& subject, Then then = Then::dropped);

  /// Announces the number of bytes that stream() will pass, for progress reports.
  virtual void expect(std::uint64_t /*bytes*/) {}

  /// Discards arrays that will not be read.
  virtual void drop(std::span<const std::uint64_t> arrays) noexcept = 0;
};

}  // namespace tessera::io
