// SPDX-License-Identifier: BSD-3-Clause
#include "io/files/whole_file.hpp"

#include <fmt/format.h>
#include <sys/mman.h>

#include <new>

#include "io/files/inflated_file.hpp"
#include "io/files/input_file.hpp"
#include "system/positional_file.hpp"

namespace tessera::io {

WholeFile::WholeFile(const std::filesystem::path& file) {
  const system::PositionalFile opened = open_input(file);
  size_ = opened.size();
  // A file inflated by this process is in memory already, and other processes cannot shorten it.
  const bool is_mapped = is_inflated(file);
  start_ = is_mapped ? ::mmap(nullptr, size_, PROT_READ, MAP_PRIVATE, opened.descriptor(), 0)
                     : ::mmap(nullptr, size_, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
  if (start_ == MAP_FAILED) throw std::bad_alloc();
  if (is_mapped) return;
  ::madvise(start_, size_, MADV_HUGEPAGE);  // otherwise page faults would take most of the time
  try {
    opened.read(0, static_cast<std::byte*>(start_), size_);
  } catch (...) {
    ::munmap(start_, size_);
    throw;
  }
}

WholeFile::~WholeFile() { ::munmap(start_, size_); }

}  // namespace tessera::io
