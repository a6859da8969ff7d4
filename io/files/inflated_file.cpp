// SPDX-License-Identifier: BSD-3-Clause
#include "io/files/inflated_file.hpp"

#include <fmt/format.h>
#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <new>
#include <string_view>

#include "io/files/input_file.hpp"
#include "system/free_memory.hpp"
#include "system/positional_file.hpp"

namespace tessera::io {

namespace {

/// Beginning of the name of the unnamed file. The name ends with the size of the gzip file, so that helpers know that
/// size, too.
constexpr std::string_view name_begin = "tessera-gzip-";

system::InflateLimit limit_of(const InputFile& packed, InflatedFile::Holds holds) {
  constexpr std::uint64_t always = 64 << 20;
  return {always + static_cast<std::uint64_t>(holds) * packed.size, false};
}

}  // namespace

InflatedFile::InflatedFile(const InputFile& file, Holds holds) : InflatedFile(file, limit_of(file, holds)) {}

InflatedFile::InflatedFile(const InputFile& file, std::uint64_t first)
    : InflatedFile(file, system::InflateLimit{first, true}) {}

InflatedFile::InflatedFile(const InputFile& file, const system::InflateLimit& limit)
    : content_(file), descriptor_(::memfd_create(fmt::format("{}{}", name_begin, file.size).c_str(), MFD_CLOEXEC)) {
  if (!descriptor_.is_open()) throw std::bad_alloc();
  const system::PositionalFile packed(file.path);
  content_.size = system::inflate_to(descriptor_.get(), packed, limit, system::available_memory() / 10 * 9, file.name);
  if (content_.size == 0) throw scene::bad_input(fmt::format("{}: it is empty; write the file again", file.name));
  // The path contains the process id, because the helper opens it, too.
  content_.path = fmt::format("/proc/{}/fd/{}", ::getpid(), descriptor_.get());
  content_.is_gzip = false;
}

std::string InflatedFile::renamed(std::string line) const {
  const std::string from = content_.path.string(), &to = content_.name;
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
        fmt::format("{}: HDF5 files cannot be read from gzip; unpack it with gunzip", file.string()));
}

void require_uncompressed(const std::filesystem::path& file) {
  if (is_inflated(file))
    throw scene::bad_input(fmt::format(
        "{}: it refers to other files, which cannot be found from within a gzip file; unpack it with gunzip",
        file.string()));
}

scene::Error InflatedFile::renamed(const scene::Error& error) const {
  return scene::with_subject(scene::Error(error.code(), renamed(std::string(error.what()))), content_.name);
}

}  // namespace tessera::io
