// SPDX-License-Identifier: BSD-3-Clause
#include "readers/vtk/odd_numbers.hpp"

#include <fmt/format.h>
#include <sys/mman.h>
#include <vtkCompositeDataIterator.h>
#include <vtkCompositeDataSet.h>
#include <vtkDataArray.h>
#include <vtkDataObject.h>
#include <vtkFieldData.h>
#include <vtkPointSet.h>
#include <vtkPoints.h>
#include <vtkRectilinearGrid.h>
#include <vtkSmartPointer.h>

#include <algorithm>
#include <array>
#include <limits>
#include <new>
#include <string_view>

#include "io/files/whole_file.hpp"
#include "tessera/program/text.hpp"

namespace tessera::readers {
namespace {

/// The placeholder for a word, and the number that the word means. The placeholder is a float, so that arrays of floats
/// represent it exactly.
struct Substitute {
  double number, meant;
};
constexpr std::array<Substitute, 3> substitutes{{{0x1.5a5a5ap-63, std::numeric_limits<double>::quiet_NaN()},
                                                 {0x1.6b6b6cp-63, std::numeric_limits<double>::infinity()},
                                                 {-0x1.6b6b6cp-63, -std::numeric_limits<double>::infinity()}}};

bool is_number(std::string_view word) {
  return is_digit(word.front()) || word.front() == '.' ||
         ((word.front() == '-' || word.front() == '+') && word.size() > 1);
}

/// Returns the placeholder for a word; null if the word does not need one.
const Substitute* substitute_of(std::string_view word) {
  std::string lower = lower_case(word.substr(0, 12));
  const bool is_negative = lower.front() == '-';
  if (is_negative || lower.front() == '+') lower.erase(0, 1);
  if (lower == "nan" || lower.starts_with("nan(") || lower.starts_with("1.#qnan") || lower.starts_with("1.#snan") ||
      lower.starts_with("1.#ind"))
    return substitutes.data();
  if (lower == "inf" || lower == "infinity" || lower.starts_with("1.#inf")) return &substitutes[is_negative ? 2 : 1];
  return nullptr;
}

/// Returns the line after replacing words by placeholders; empty if no word needs a placeholder, or if some words are
/// not numbers.
std::string replaced(std::string_view line) {
  std::string result;
  bool any = false;
  for (const std::string_view word : split_words(line)) {
    const Substitute* const odd = substitute_of(word);
    if (odd == nullptr && !is_number(word)) return "";
    any = any || odd != nullptr;
    result += odd == nullptr ? std::string(word) : fmt::format("{:.17g}", odd->number);
    result += ' ';
  }
  return any ? result : "";
}

void restore_array(vtkDataArray* array) {
  if (array == nullptr || (array->GetDataType() != VTK_FLOAT && array->GetDataType() != VTK_DOUBLE)) return;
  for (vtkIdType tuple = 0; tuple < array->GetNumberOfTuples(); ++tuple)
    for (int k = 0; k < array->GetNumberOfComponents(); ++k)
      for (const Substitute& odd : substitutes)
        if (array->GetComponent(tuple, k) == odd.number) array->SetComponent(tuple, k, odd.meant);
}

void restore_one(vtkDataObject& data) {
  for (int kind = 0; kind < vtkDataObject::NUMBER_OF_ATTRIBUTE_TYPES; ++kind)
    if (vtkFieldData* const fields = data.GetAttributesAsFieldData(kind); fields != nullptr)
      for (int k = 0; k < fields->GetNumberOfArrays(); ++k) restore_array(fields->GetArray(k));
  if (auto* points = vtkPointSet::SafeDownCast(&data); points != nullptr && points->GetPoints() != nullptr)
    restore_array(points->GetPoints()->GetData());
  if (auto* grid = vtkRectilinearGrid::SafeDownCast(&data))
    for (vtkDataArray* axis : {grid->GetXCoordinates(), grid->GetYCoordinates(), grid->GetZCoordinates()})
      restore_array(axis);
}

}  // namespace

OddNumbers::OddNumbers(const std::filesystem::path& file) : file_(file) {
  const io::WholeFile mapped(file);
  const std::string_view text = mapped.text();
  const std::string_view beginning = text.substr(0, 4096);
  if (beginning.find('\0') != std::string_view::npos || beginning.find("\nBINARY") != std::string_view::npos) return;
  std::size_t done = 0;  // length of the text copied so far
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = std::min(text.find('\n', at), text.size());
    const std::string_view line = text.substr(at, end - at);
    if (line.find_first_of("nN#") != std::string_view::npos)
      if (const std::string other = replaced(line); !other.empty()) {
        text_.append(text, done, at - done).append(other);
        done = end;
      }
    at = end + 1;
  }
  if (done > 0) text_.append(text, done);
}

std::string OddNumbers::file_name() {
  if (!any()) return file_.string();
  if (!in_memory_.is_open()) in_memory_ = system::Descriptor(::memfd_create("tessera", MFD_CLOEXEC));
  if (!in_memory_.is_open() || !system::write_all(in_memory_.get(), text_.data(), text_.size())) throw std::bad_alloc();
  return fmt::format("/proc/self/fd/{}", in_memory_.get());
}

void OddNumbers::restore(vtkDataObject* data) const {
  if (!any() || data == nullptr) return;
  auto* const composite = vtkCompositeDataSet::SafeDownCast(data);
  if (composite == nullptr) return restore_one(*data);
  const auto each = vtkSmartPointer<vtkCompositeDataIterator>::Take(composite->NewIterator());
  for (each->InitTraversal(); !each->IsDoneWithTraversal(); each->GoToNextItem())
    restore_one(*each->GetCurrentDataObject());
}

}  // namespace tessera::readers
