#pragma once

#include <fmt/format.h>

#include <string>
#include <vector>

#include "io/foreign_file.hpp"
#include "scene/error.hpp"

namespace tessera::io {

/// All numbers of an array, whose type the caller has looked at.
template <class T>
std::vector<T> numbers_of(const ForeignFile& file, const ForeignArray& array) {
  const SharedBytes shared = file.helper->take(array, file.source);
  const auto numbers = shared.as<T>();
  return {numbers.begin(), numbers.end()};
}

[[noreturn]] inline void refuse_surface(const std::string& source) {
  throw scene::bad_input(fmt::format("{}: it holds no surface; give another file", source));
}

}  // namespace tessera::io
