#pragma once

#include <cstring>
#include <span>
#include <type_traits>

#include "exchange/transport.hpp"
#include "scene/error.hpp"

namespace tessera::frame {

/// Puts values behind a message, as they lie in memory: little endian, as all ranks are.
template <class T>
void append_values(exchange::Bytes& message, std::span<const T> values) {
  static_assert(std::is_trivially_copyable_v<T>);
  const auto raw = std::as_bytes(values);
  message.insert(message.end(), raw.begin(), raw.end());
}

/// Takes values off the front of a message. Throws Error(system_failure) where it is shorter.
class ValueReader {
 public:
  explicit ValueReader(std::span<const std::byte> message) : left_(message) {}

  template <class T>
  void take(std::span<T> values) {
    static_assert(std::is_trivially_copyable_v<T>);
    if (values.size_bytes() > left_.size())
      throw scene::Error(scene::ErrorCode::system_failure,
                         "exchange: a message is shorter than it says; all ranks must run the same program");
    if (!values.empty()) std::memcpy(values.data(), left_.data(), values.size_bytes());
    left_ = left_.subspan(values.size_bytes());
  }
  template <class T>
  T take() {
    T value{};
    take(std::span(&value, 1));
    return value;
  }

 private:
  std::span<const std::byte> left_;
};

}  // namespace tessera::frame
