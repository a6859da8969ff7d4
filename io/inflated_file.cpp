#include "io/inflated_file.hpp"

#include <fmt/format.h>
#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <cstdint>
#include <new>

#include "io/free_memory.hpp"
#include "io/gzip.hpp"
#include "io/input_file.hpp"
#include "io/mapped_file.hpp"

namespace tessera::io {

InflatedFile::InflatedFile(const std::filesystem::path& file)
    : file_(file), descriptor_(::memfd_create("tessera", MFD_CLOEXEC)) {
  if (!descriptor_.is_open()) throw std::bad_alloc();
  const MappedFile mapped(file);
  if (inflate_to(descriptor_.get(), mapped.bytes(), available_memory() / 10 * 9, file.string()) == 0)
    throw scene::bad_input(fmt::format("{}: it holds nothing; write it anew", file.string()));
  // By number, since the helper opens it too.
  path_ = fmt::format("/proc/{}/fd/{}", ::getpid(), descriptor_.get());
}

std::filesystem::path InflatedFile::inner_name() const {
  return lower_extension(file_) == ".gz" ? file_.parent_path() / file_.stem() : file_;
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
