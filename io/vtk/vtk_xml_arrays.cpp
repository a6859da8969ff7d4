// SPDX-License-Identifier: BSD-3-Clause
#include "io/vtk/vtk_xml_arrays.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "scene/error.hpp"
#include "tessera/program/text.hpp"

namespace tessera::io {

ForeignArray VtkXmlArrays::hold(ForeignArray array, Stream stream) {
  const std::lock_guard lock(mutex_);
  array.number = next_++;
  held_.emplace(array.number, std::make_shared<const Stream>(std::move(stream)));
  return array;
}

void VtkXmlArrays::stream(const ForeignArray& array, const std::string& subject, const system::ByteSink& use,
                          Then then) {
  std::shared_ptr<const Stream> stream;
  {
    const std::lock_guard lock(mutex_);
    if (const auto held = held_.find(array.number); held != held_.end()) stream = held->second;
  }
  if (!stream) throw scene::bad_input(fmt::format("{}: its array {} was read before", subject, quote(array.name)));
  (*stream)([&](std::span<const std::byte> tuples) {
    use(tuples);
    const std::uint64_t expected = expected_, before = came_.fetch_add(tuples.size());
    if (progress_ && before < expected)
      progress_({ReadProgress::Stage::copying,
                 std::min(static_cast<double>(before + tuples.size()) / static_cast<double>(expected), 1.0)});
  });
  if (then == Then::dropped) drop(std::span(&array.number, 1));
}

void VtkXmlArrays::drop(std::span<const std::uint64_t> arrays) noexcept {
  const std::lock_guard lock(mutex_);
  for (const std::uint64_t number : arrays) held_.erase(number);
}

}  // namespace tessera::io
