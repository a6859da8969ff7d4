// SPDX-License-Identifier: BSD-3-Clause
#include "io/formats/inflated_file.hpp"

#include <fmt/format.h>
#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <new>
#include <string_view>

#include "io/formats/input_file.hpp"
#include "system/free_memory.hpp"
#include "system/positional_file.hpp"

namespace tessera::io {

namespace {

/// The name of the file without a name, which ends in the gzip file's size, so that helpers know it too.
constexpr std::string_view name_begin = "tessera-gzip-";

system::InflateLimit limit_of(const std::filesystem::path& packed, InflatedFile::Holds holds) {
  constexpr std::uint64_t always = 64 << 20;
  return {always + static_cast<std::uint64_t>(holds) * require_file(packed), false};
}

}  // namespace

InflatedFile::InflatedFile(const std::filesystem::path& file, Holds holds)
    : InflatedFile(file, system::PositionalFile(file), limit_of(file, holds)) {}

InflatedFile::InflatedFile(const std::filesystem::path& file, std::uint64_t first)
    : InflatedFile(file, system::PositionalFile(file), system::InflateLimit{first, true}) {}

InflatedFile::InflatedFile(const std::filesystem::path& file, const system::PositionalFile& packed,
                           const system::InflateLimit& limit)
    : file_(file), descriptor_(::memfd_create(fmt::format("{}{}", name_begin, packed.size()).c_str(), MFD_CLOEXEC)) {
  if (!descriptor_.is_open()) throw std::bad_alloc();
  if (system::inflate_to(descriptor_.get(), packed, limit, system::available_memory() / 10 * 9, file.string()) == 0)
    throw scene::bad_input(fmt::format("{}: it holds nothing; write it anew", file.string()));
  // By number, since the helper opens it too.
  path_ = fmt::format("/proc/{}/fd/{}", ::getpid(), descriptor_.get());
}

std::filesystem::path InflatedFile::inner_name() const {
  return system::lower_extension(file_) == ".gz" ? file_.parent_path() / file_.stem() : file_;
}

std::string InflatedFile::renamed(std::string line) const {
  const std::string from = path_.string(), to = file_.string();
  for (std::size_t at = line.find(from); at != std::string::npos; at = line.find(from, at + to.size()))
    line.replace(at, from.size(), to);
  return line;
}

bool is_inflated(const std::filesystem::path& file) {
  const std::string name = file.string();
  return name.starts_with("/proc/") && file.parent_path().filename() == "fd";
}

std::uint64_t packed_size(const std::filesystem::path& inflated) {
  std::error_code unknown;
  const std::string link = std::filesystem::read_symlink(inflated, unknown).string();
  std::uint64_t size = 0;
  if (const std::size_t at = link.find(name_begin); at != std::string::npos)
    std::from_chars(link.data() + at + name_begin.size(), link.data() + link.size(), size);
  return size;
}

void require_real_name(const std::filesystem::path& file) {
  if (is_inflated(file))
    throw scene::bad_input(
        fmt::format("{}: HDF5's library opens no file within a gzip file; unpack it with gunzip", file.string()));
}

void require_beside_others(const std::filesystem::path& file) {
  if (is_inflated(file))
    throw scene::bad_input(
        fmt::format("{}: it goes with other files, which cannot be found from within a gzip file; unpack it with "
                    "gunzip",
                    file.string()));
}

scene::Error InflatedFile::renamed(const scene::Error& error) const {
  return scene::with_subject(scene::Error(error.code(), renamed(std::string(error.what()))), file_.string());
}

}  // namespace tessera::io
