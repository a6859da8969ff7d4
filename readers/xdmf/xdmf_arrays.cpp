// SPDX-License-Identifier: BSD-3-Clause
#include "readers/xdmf/xdmf_arrays.hpp"

#include <fmt/format.h>

#include <XdmfArray.hpp>
#include <XdmfArrayType.hpp>
#include <XdmfBinaryController.hpp>
#include <XdmfHeavyDataController.hpp>
#include <algorithm>

#include "io/files/inflated_file.hpp"
#include "io/files/input_file.hpp"
#include "readers/common/hdf5_references.hpp"
#include "readers/common/readers.hpp"
#include "readers/xdmf/xdmf_references.hpp"
#include "scene/error.hpp"
#include "tessera/program/text.hpp"

namespace tessera::readers {
namespace {

template <class T>
std::vector<T> numbers_of(const XdmfArray& array) {
  std::vector<T> numbers(array.getSize());
  if (!numbers.empty()) array.getValues<T>(0, numbers.data(), static_cast<unsigned>(numbers.size()), 1, 1);
  return numbers;
}

template <class T>
cells::NumberTally tally_of(const std::vector<T>& numbers, NumberType type, int components) {
  cells::NumberTally tally;
  const std::size_t tuples = numbers.size() / static_cast<std::size_t>(components);
  std::vector<double> some(std::min<std::size_t>(tuples, 4096));
  for (std::size_t first = 0; first < tuples; first += some.size()) {
    const std::span chunk = std::span(some).first(std::min(some.size(), tuples - first));
    io::read_tuples(std::as_bytes(std::span(numbers)), type, components, components == 1 ? 0 : cells::magnitude, first,
                    chunk);
    tally.add(chunk);
  }
  return tally;
}

}  // namespace

XdmfHeavyFiles::XdmfHeavyFiles(const std::filesystem::path& file) : source_(file.string()) {
  std::error_code unknown;  // set for the content of a gzip file, which has no directory
  folder_ = std::filesystem::weakly_canonical(file, unknown).parent_path();
  files_.push_back(std::filesystem::absolute(file));  // the current directory may change later
}

void XdmfHeavyFiles::add(XdmfArray& array) {
  for (XdmfArray* const other : referenced_arrays(array, source_)) add(*other);
  for (unsigned k = 0; k < array.getNumberHeavyDataControllers(); ++k) {
    io::require_uncompressed(source_);
    const std::filesystem::path named = array.getHeavyDataController(k)->getFilePath();
    std::error_code unknown;
    const std::filesystem::path file = std::filesystem::canonical(named, unknown);
    if (unknown || !std::filesystem::is_regular_file(file, unknown))
      throw scene::bad_input(fmt::format("{}: its data are in {}, which does not exist; put the file there", source_,
                                         quote(named.filename().string())));
    if (std::mismatch(folder_.begin(), folder_.end(), file.begin(), file.end()).first != folder_.end())
      throw scene::bad_input(
          fmt::format("{}: its data are in {}, which is neither in its directory nor below; move that file there and "
                      "correct the reference",
                      source_, quote(named.string())));
    const auto* const binary = dynamic_cast<const XdmfBinaryController*>(array.getHeavyDataController(k).get());
    if (binary != nullptr) require_size(*binary, file);
    if (std::find(files_.begin(), files_.end(), file) != files_.end()) continue;
    files_.push_back(file);
    if (binary == nullptr) require_sound_references(file, ReferencesMay::point_below);
  }
}

/// Throws if a file is too short, because Xdmf replaces missing bytes by zeros.
void XdmfHeavyFiles::require_size(const XdmfBinaryController& numbers, const std::filesystem::path& file) const {
  const std::uint64_t size = io::require_file(file),
                      least = numbers.getSeek() +
                              std::uint64_t{numbers.getDataspaceSize()} * numbers.getType()->getElementSize();
  if (size < least)
    throw scene::bad_input(
        fmt::format("{}: its data in {} end at byte {}, but that file has {} bytes; write both again", source_,
                    quote(file.filename().string()), least, size));
}

void XdmfHeavyFiles::allow() const { allow_for_files(files_); }

std::vector<double> doubles_of(XdmfArray& array) {
  read_numbers(array);
  return numbers_of<double>(array);
}

io::ForeignArray hold_xdmf(Holdings& holdings, XdmfArray& array, const std::string& name, int components,
                           bool is_kept) {
  read_numbers(array);
  const NumberType type = number_type_of(array);
  return io::with_number_type(type, [&](auto zero) {
    std::vector<decltype(zero)> numbers = numbers_of<decltype(zero)>(array);
    io::ForeignArray held{.name = name, .type = type, .components = components};
    held.tally = tally_of(numbers, type, components);
    if (!is_kept) array.release();
    return hold_vector(holdings, std::move(held), std::move(numbers));
  });
}

}  // namespace tessera::readers
