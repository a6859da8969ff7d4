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
/// Bytes   are CBOR. io/foreign/client/helper_process.cpp and readers/common/serve.cpp define requests and replies.
/// Arrays  are unnamed files (memfd_create). The receiver seals them, so that they cannot shrink while they are mapped.
///         Alternatively, arrays are sent in parts through a window: an unnamed file that is reused.

/// Protocol version. The helper sends it first; any other version is refused.
inline constexpr int helper_version = 6;

struct HelperMessage {
  std::vector<std::uint8_t> bytes;
  system::Descriptor file;
};

/// Returns false if the other side has closed the socket.
bool send_message(int socket, std::span<const std::uint8_t> bytes, int file = -1);

/// Returns no value if the other side has closed the socket or sends an invalid message.
std::optional<HelperMessage> receive_message(int socket);

}  // namespace tessera::io
