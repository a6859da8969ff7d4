// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <cstdint>
#include <fstream>

#include "io/files/inflated_file.hpp"
#include "io/files/input_file.hpp"
#include "readers/common/readers.hpp"
#include "readers/common/sandbox.hpp"

namespace tessera::readers {
namespace {

std::uint64_t address_space_in_use() {
  std::uint64_t pages = 0;
  std::ifstream("/proc/self/statm") >> pages;
  return pages * static_cast<std::uint64_t>(::sysconf(_SC_PAGESIZE));
}

double processor_seconds() {
  rusage usage{};
  ::getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_utime.tv_sec + usage.ru_stime.tv_sec);
}

/// Sets a soft limit of this process. Returns false if the hard limit is lower.
bool set_soft_limit(decltype(RLIMIT_AS) what, std::uint64_t value) {
  rlimit limit{};
  if (::getrlimit(what, &limit) != 0) return true;
  limit.rlim_cur = std::min<std::uint64_t>(value, limit.rlim_max);
  ::setrlimit(what, &limit);
  return limit.rlim_cur == value;
}

/// Whether the last file got all the memory that allow() requested.
bool had_enough_memory = true;

/// Whether the content of a file may be a thousand times larger than the file.
bool may_be_compressed(const std::filesystem::path& file) {
  const std::string beginning = io::read_beginning(file, 4096);
  return beginning.find("compressor=") != std::string::npos || beginning.find("\x89HDF\r\n") != std::string::npos ||
         beginning.starts_with("\x1f\x8b");
}

/// Sets the limits to what the process has used so far plus `bytes` and `seconds`.
void allow(std::uint64_t bytes, double seconds) {
  // Sanitizers reserve most of the address space.
  if (!is_sanitized) had_enough_memory = set_soft_limit(RLIMIT_AS, address_space_in_use() + bytes);
  set_soft_limit(RLIMIT_CPU, static_cast<std::uint64_t>(processor_seconds() + seconds * (is_sanitized ? 10 : 1)) + 1);
}

// Text of one digit and a blank becomes a double and an index, and readers may have two copies of these. The best ratio
// of deflate is 1032 to 1.
constexpr double text_factor = 24, packed_factor = 1100;
constexpr std::uint64_t base_bytes = 256ull << 20;
// Slow readers parse 2 MB/s of text; compressed files take ten times as long.
constexpr double base_seconds = 8, text_bytes_a_second = 2e6;

/// Allows memory and time for files of `size` bytes.
void allow_for_bytes(std::uint64_t size, bool is_compressed) {
  const double bytes = static_cast<double>(size) * (is_compressed ? packed_factor : text_factor);
  allow(base_bytes + static_cast<std::uint64_t>(bytes),
        base_seconds + static_cast<double>(size) / (is_compressed ? text_bytes_a_second / 10 : text_bytes_a_second));
}

}  // namespace

void allow_for(const std::filesystem::path& file) {
  if (!io::is_inflated(file)) return allow_for_bytes(io::require_file(file), may_be_compressed(file));
  // The limit is that of a file with this content. Together with the content, it is at most the limit of a compressed
  // file of the packed size, but it is at least twice the content.
  const double held = static_cast<double>(io::require_file(file)), packed = static_cast<double>(io::packed_size(file));
  const double bytes = std::max(std::min(text_factor * held, packed_factor * packed - held), 2 * held);
  allow(base_bytes + static_cast<std::uint64_t>(bytes), base_seconds + held / text_bytes_a_second);
}

void allow_for_files(std::span<const std::filesystem::path> files) {
  std::uint64_t bytes = 0;
  bool is_compressed = false;
  for (const std::filesystem::path& file : files) {
    bytes += io::require_file(file);
    is_compressed = is_compressed || may_be_compressed(file);
  }
  allow_for_bytes(bytes, is_compressed);
}

void allow_for_folder(const std::filesystem::path& folder, bool is_compressed) {
  std::uint64_t bytes = 0;
  std::error_code error;
  std::filesystem::recursive_directory_iterator entry(folder, error);
  for (std::size_t files = 0; !error && entry != std::filesystem::recursive_directory_iterator() && files < 1000000;
       ++files) {
    std::error_code unknown;
    if (entry->is_regular_file(unknown)) bytes += entry->file_size(unknown);
    entry.increment(error);
  }
  allow_for_bytes(std::min<std::uint64_t>(bytes, 1ull << 42), is_compressed);
}

void allow_filling(std::size_t facets, double tets, bool is_chosen) {
  // Measured on spheres: each facet takes at most 6 KiB, and 0.2 ms up to 330,000 facets, but over 0.6 ms at 10^6
  // facets; each tet takes 1 KiB and 0.02 ms. A damaged surface may have slivers that take any amount of memory and
  // time. The limit is therefore twice the amount that sound surfaces need plus 256 MiB.
  constexpr double base = 256 << 20;
  const double bytes = base + 12288.0 * static_cast<double>(facets), seconds = 15 + 4e-3 * static_cast<double>(facets);
  if (!is_chosen) return allow(static_cast<std::uint64_t>(bytes), seconds);
  const double many = std::clamp(tets, 0.0, 1e10);
  allow(static_cast<std::uint64_t>(32 * (bytes + 1024 * many)), 40 * (seconds + 2e-4 * many));
}

scene::Error memory_error(const std::string& source, std::string_view damage) {
  if (had_enough_memory) return scene::bad_input(fmt::format("{}: {}", source, damage));
  return {scene::ErrorCode::system_failure, source, "memory ran out", "use a larger machine or a part of the data"};
}

}  // namespace tessera::readers
