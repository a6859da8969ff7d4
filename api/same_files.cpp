// SPDX-License-Identifier: BSD-3-Clause
#include "api/same_files.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>
#include <zlib.h>

#include <array>
#include <map>
#include <optional>
#include <string>

#include "exchange/collectives.hpp"
#include "scene/error.hpp"
#include "system/files_read.hpp"

namespace tessera::api {
namespace {

struct Fingerprint {
  std::uint64_t bytes, checksum;
  bool operator==(const Fingerprint&) const = default;
};

/// Returns none unless the file is regular and readable.
std::optional<Fingerprint> fingerprint_of(const std::string& name) {
  constexpr std::uint64_t all_of = 1 << 20, places = 64, piece = 1 << 14;
  const int file = ::open(name.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
  if (file < 0) return std::nullopt;
  struct stat facts {};
  std::optional<Fingerprint> found;
  if (::fstat(file, &facts) == 0 && S_ISREG(facts.st_mode)) {
    found = {static_cast<std::uint64_t>(facts.st_size), ::crc32_z(0, nullptr, 0)};
    const std::uint64_t pieces = found->bytes <= all_of ? (found->bytes + piece - 1) / piece : places;
    for (std::uint64_t i = 0; i < pieces; ++i) {
      std::array<unsigned char, piece> bytes{};
      const std::uint64_t at = found->bytes <= all_of ? i * piece : (found->bytes - piece) / (places - 1) * i;
      const ssize_t got = ::pread(file, bytes.data(), bytes.size(), static_cast<off_t>(at));
      if (got > 0) found->checksum = ::crc32_z(found->checksum, bytes.data(), static_cast<std::size_t>(got));
    }
  }
  ::close(file);
  return found;
}

struct Seen {
  int rank;
  Fingerprint file;
};

}  // namespace

void require_same_files(exchange::Transport& transport) {
  if (transport.size() == 1) return;
  exchange::Bytes own = exchange::begin_message(exchange::MessageKind::files_read);
  for (const std::string& name : system::take_names_read())
    if (const auto file = fingerprint_of(name)) {
      exchange::append_text(own, name);
      exchange::append(own, *file);
    }
  std::map<std::string, Seen> seen;
  const std::vector<exchange::Bytes> all = exchange::gather_all(transport, std::move(own));
  for (int rank = 0; rank < transport.size(); ++rank) {
    exchange::MessageReader reader(all[static_cast<std::size_t>(rank)], rank, exchange::MessageKind::files_read);
    while (!reader.empty()) {
      const std::string name = reader.take_text();
      const auto file = reader.take<Fingerprint>();
      if (rank != 0 && transport.rank() == 0 && !seen.contains(name))
        if (const auto here = fingerprint_of(name)) seen.emplace(name, Seen{0, *here});
      const auto [first, is_new] = seen.try_emplace(name, Seen{rank, file});
      if (first->second.file != file)
        throw scene::bad_input(
            fmt::format("{}: ranks {} and {} have different files of this name, of {} and {} bytes; give all ranks the "
                        "same, on a disk that they share or as copies",
                        name, first->second.rank, rank, first->second.file.bytes, file.bytes));
    }
  }
}

}  // namespace tessera::api
