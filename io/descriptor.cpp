#include "io/descriptor.hpp"

#include <unistd.h>

#include <utility>

namespace tessera::io {

Descriptor::~Descriptor() {
  if (number_ >= 0) ::close(number_);
}

Descriptor& Descriptor::operator=(Descriptor&& other) noexcept {
  Descriptor old(std::exchange(number_, other.release()));
  return *this;
}

int Descriptor::release() { return std::exchange(number_, -1); }

}  // namespace tessera::io
