// SPDX-License-Identifier: BSD-3-Clause
#include "io/foreign/messages/helper_messages.hpp"

#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <utility>

namespace tessera::io {
namespace {

/// Longer than any valid description of a file.
constexpr std::uint64_t longest_message = 1ull << 31;

bool receive_all(int socket, std::uint8_t* bytes, std::size_t count) {
  while (count > 0) {
    const ssize_t got = ::recv(socket, bytes, count, MSG_WAITALL);
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) return false;
    bytes += got;
    count -= static_cast<std::size_t>(got);
  }
  return true;
}

}  // namespace

bool send_message(int socket, std::span<const std::uint8_t> bytes, int file) {
  std::uint64_t count = bytes.size();
  iovec part{&count, sizeof count};
  alignas(cmsghdr) char control[CMSG_SPACE(sizeof(int))] = {};
  msghdr head{};
  head.msg_iov = &part;
  head.msg_iovlen = 1;
  if (file >= 0) {
    head.msg_control = control;
    head.msg_controllen = sizeof control;
    cmsghdr* const rights = CMSG_FIRSTHDR(&head);
    rights->cmsg_level = SOL_SOCKET;
    rights->cmsg_type = SCM_RIGHTS;
    rights->cmsg_len = CMSG_LEN(sizeof(int));
    std::memcpy(CMSG_DATA(rights), &file, sizeof file);
  }
  ssize_t sent = 0;
  do sent = ::sendmsg(socket, &head, MSG_NOSIGNAL);
  while (sent < 0 && errno == EINTR);
  if (sent != static_cast<ssize_t>(sizeof count)) return false;
  while (!bytes.empty()) {
    const ssize_t part_sent = ::send(socket, bytes.data(), bytes.size(), MSG_NOSIGNAL);
    if (part_sent < 0 && errno == EINTR) continue;
    if (part_sent <= 0) return false;
    bytes = bytes.subspan(static_cast<std::size_t>(part_sent));
  }
  return true;
}

std::optional<HelperMessage> receive_message(int socket) {
  std::uint64_t count = 0;
  iovec part{&count, sizeof count};
  alignas(cmsghdr) char control[CMSG_SPACE(sizeof(int))] = {};
  msghdr head{};
  head.msg_iov = &part;
  head.msg_iovlen = 1;
  head.msg_control = control;
  head.msg_controllen = sizeof control;
  ssize_t got = 0;
  do got = ::recvmsg(socket, &head, MSG_WAITALL | MSG_CMSG_CLOEXEC);
  while (got < 0 && errno == EINTR);
  HelperMessage message;
  if (const cmsghdr* const rights = got > 0 ? CMSG_FIRSTHDR(&head) : nullptr;
      rights != nullptr && rights->cmsg_level == SOL_SOCKET && rights->cmsg_type == SCM_RIGHTS) {
    int file = -1;
    std::memcpy(&file, CMSG_DATA(rights), sizeof file);
    message.file = system::Descriptor(file);
  }
  if (got != static_cast<ssize_t>(sizeof count) || count > longest_message) return std::nullopt;
  // Memory grows as bytes arrive: the count alone is not trusted.
  constexpr std::size_t step = 1 << 20;
  while (message.bytes.size() < count) {
    const std::size_t before = message.bytes.size(), more = std::min<std::size_t>(step, count - before);
    message.bytes.resize(before + more);
    if (!receive_all(socket, message.bytes.data() + before, more)) return std::nullopt;
  }
  return message;
}

}  // namespace tessera::io
