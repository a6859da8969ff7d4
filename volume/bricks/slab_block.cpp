// SPDX-License-Identifier: BSD-3-Clause
#include "volume/bricks/slab_block.hpp"

#include <sys/mman.h>

#include <cstdlib>
#include <new>

namespace tessera::volume {

void FloatRoom::make_room(std::size_t count) {
  if (count_ >= count) return;
  // Frees the old memory first: its contents are not needed.
  let_go();
  constexpr std::size_t large = 1 << 18;
  const std::size_t room = count + count / 8;
  void* memory = nullptr;
  if (room >= large) {
    memory = ::mmap(nullptr, room * sizeof(float), PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    if (memory == MAP_FAILED) throw std::bad_alloc();
  } else {
    memory = std::calloc(room, sizeof(float));
    if (memory == nullptr) throw std::bad_alloc();
  }
  first_ = static_cast<float*>(memory);
  count_ = room;
  mapped_ = room >= large;
}

void FloatRoom::let_go() {
  if (mapped_)
    ::munmap(first_, count_ * sizeof(float));
  else
    std::free(first_);
  first_ = nullptr;
  count_ = 0;
  mapped_ = false;
}

}  // namespace tessera::volume
