// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "system/descriptor.hpp"

namespace tessera::io {

/// A message on the socket between a process and its helper program: a byte count (uint64, native byte order), the
/// bytes, and at most one file descriptor attached to them.
///
/// Bytes   CBOR. Requests and replies are in io/foreign/client/helper_process.cpp and readers/common/serve.cpp.
/// Arrays  unnamed files (memfd_create). The receiver seals them, so that they cannot shrink while they are mapped. Or
///         they are sent in parts through a window, which is such a file too and is reused.

/// Protocol version. The helper sends it first; any other version is refused.
inline constexpr int helper_version = 6;

struct HelperMessage {
  std::vector<std::uint8_t> bytes;
  system::Descriptor file;
};

/// False if the other side has closed.
bool send_message(int socket, std::span<const std::uint8_t> bytes, int file = -1);

/// No value if the other side has closed or sends an invalid message.
std::optional<HelperMessage> receive_message(int socket);

}  // namespace tessera::io
