#include "io/mapped_file.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/mman.h>
#include <unistd.h>

#include "io/input_file.hpp"
#include "scene/error.hpp"

namespace tessera::io {

MappedFile::MappedFile(const std::filesystem::path& file) : size_(require_file(file)) {
  const int descriptor = ::open(file.c_str(), O_RDONLY | O_CLOEXEC);
  start_ = descriptor < 0 ? MAP_FAILED : ::mmap(nullptr, size_, PROT_READ, MAP_PRIVATE, descriptor, 0);
  if (descriptor >= 0) ::close(descriptor);
  if (start_ == MAP_FAILED)
    throw scene::Error(scene::ErrorCode::system_failure,
                       fmt::format("{}: it cannot be mapped into memory; check disk and memory limits", file.string()));
}

MappedFile::~MappedFile() { ::munmap(start_, size_); }

}  // namespace tessera::io
