// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "io/foreign/messages/array_source.hpp"
#include "system/byte_sink.hpp"
#include "tessera/read_progress.hpp"

namespace tessera::io {

/// The arrays of a file that this process reads itself. When an array is requested, its numbers are read from the file
/// or from memory.
class VtkXmlArrays final : public ArraySource {
 public:
  using Stream = std::function<void(const system::ByteSink& use)>;

  /// `progress` is called with the fraction of the expected bytes that were copied; may be null.
  explicit VtkXmlArrays(ReadProgressFunction progress = {}) : progress_(std::move(progress)) {}

  /// Adds an array: assigns its number, and stores the function that passes its bytes in whole tuples.
  ForeignArray hold(ForeignArray array, Stream stream);

  /// Adds an array whose numbers are in memory; their count determines the number of tuples.
  template <class T>
  ForeignArray hold_vector(ForeignArray array, std::vector<T> numbers) {
    array.tuples = numbers.size() / static_cast<std::size_t>(array.components);
    return hold(std::move(array), [kept = std::make_shared<const std::vector<T>>(std::move(numbers))](
                                      const system::ByteSink& use) { use(std::as_bytes(std::span(*kept))); });
  }

  using ArraySource::stream;
  void stream(const ForeignArray& array, const std::string& subject, const system::ByteSink& use, Then then) override;
  void expect(std::uint64_t bytes) override { expected_ = bytes, came_ = 0; }
  void drop(std::span<const std::uint64_t> arrays) noexcept override;

 private:
  std::mutex mutex_;
  std::map<std::uint64_t, std::shared_ptr<const Stream>> held_;
  std::uint64_t next_ = 0;
  ReadProgressFunction progress_;
  /// Bytes that stream() is expected to pass, and bytes passed so far, without fields that are read later.
  std::atomic<std::uint64_t> expected_ = 0, came_ = 0;
};

}  // namespace tessera::io
