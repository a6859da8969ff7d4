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

/// What goes over the socket between a process and its helper program: a count of bytes (uint64, this machine's order),
/// the bytes, and at most one file descriptor beside them.
///
/// Bytes   CBOR. Requests and replies are in io/foreign/client/helper_process.cpp and readers/common/serve.cpp.
/// Arrays  are files without a name (memfd_create), sealed by who receives them, so that they cannot shrink while they
///         are mapped; or go in parts through a window, which is such a file too, and stays.

/// Of the protocol. The helper says it first; another one's is refused.
inline constexpr int helper_version = 6;

struct HelperMessage {
  std::vector<std::uint8_t> bytes;
  system::Descriptor file;
};

/// False if the other side is gone.
bool send_message(int socket, std::span<const std::uint8_t> bytes, int file = -1);

/// Nothing if the other side is gone, or sends what is no message.
std::optional<HelperMessage> receive_message(int socket);

}  // namespace tessera::io
