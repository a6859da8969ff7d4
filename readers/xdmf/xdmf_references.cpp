// SPDX-License-Identifier: BSD-3-Clause
#include "readers/xdmf/xdmf_references.hpp"

#include <fmt/format.h>

#include <XdmfArray.hpp>
#include <XdmfArrayType.hpp>
#include <XdmfError.hpp>
#include <XdmfFunction.hpp>
#include <XdmfSubset.hpp>
#include <algorithm>
#include <functional>
#include <numeric>

#include "scene/error.hpp"

namespace tessera::readers {
namespace {

using Sizes = std::vector<unsigned>;

XdmfSubset* selection_of(XdmfArray& array) {
  return array.getReadMode() == XdmfArray::Reference ? dynamic_cast<XdmfSubset*>(array.getReference().get()) : nullptr;
}

/// Returns the dimensions, the slowest first, like all sizes here.
Sizes dimensions_of(XdmfArray& array) {
  const XdmfSubset* const selection = selection_of(array);
  return selection == nullptr || array.isInitialized() ? array.getDimensions() : selection->getDimensions();
}

std::uint64_t product(const Sizes& sizes) {
  return std::accumulate(sizes.begin(), sizes.end(), std::uint64_t{1}, std::multiplies<>());
}

void require_inside(const XdmfSubset& selection, const Sizes& sizes, const std::string& source) {
  const Sizes start = selection.getStart(), stride = selection.getStride(), count = selection.getDimensions();
  bool is_inside = start.size() == sizes.size();
  for (std::size_t k = 0; k < sizes.size() && is_inside; ++k)
    is_inside = count[k] > 0 && (stride[k] > 0 || count[k] == 1) &&
                start[k] + std::uint64_t{count[k] - 1} * stride[k] < sizes[k];
  if (!is_inside)
    throw scene::bad_input(fmt::format(
        "{}: a HyperSlab of start {}, stride {}, count {} does not fit an array of the dimensions {}; give "
        "three rows of as many numbers, with the slowest dimension first",
        source, fmt::join(start, " "), fmt::join(stride, " "), fmt::join(count, " "), fmt::join(sizes, " ")));
}

/// Throws if a read has the wrong length. Xdmf's library does not report this error; after the checks it cannot occur.
void require_count(std::size_t is, std::uint64_t should) {
  if (is != should)
    XdmfError::message(XdmfError::FATAL, fmt::format("there are {} numbers, but {} are required", is, should));
}

template <class T>
std::vector<T> values_of(XdmfArray& array) {
  read_numbers(array);
  std::vector<T> numbers(array.getSize());
  if (!numbers.empty()) array.getValues<T>(0, numbers.data(), static_cast<unsigned>(numbers.size()), 1, 1);
  if (array.getNumberHeavyDataControllers() > 0) array.release();  // the numbers can be read again
  return numbers;
}

/// The library interprets the first number of each row as that of the fastest dimension.
template <class T>
std::vector<T> selected(const std::vector<T>& all, const Sizes& sizes, const XdmfSubset& selection) {
  const Sizes start = selection.getStart(), stride = selection.getStride(), count = selection.getDimensions();
  require_count(all.size(), product(sizes));
  std::vector<T> numbers(product(count));
  Sizes at(count.size());
  for (T& number : numbers) {
    std::uint64_t from = 0;
    for (std::size_t k = 0; k < at.size(); ++k) from = from * sizes[k] + start[k] + std::uint64_t{at[k]} * stride[k];
    number = all[from];
    for (std::size_t k = at.size(); k-- > 0;) {
      if (++at[k] < count[k]) break;
      at[k] = 0;
    }
  }
  return numbers;
}

template <class T>
void fill(XdmfArray& array, const boost::shared_ptr<const XdmfArrayType>& type, const Sizes& sizes,
          const std::vector<T>& numbers) {
  array.initialize(type, sizes);
  array.insert(0, numbers.data(), static_cast<unsigned>(numbers.size()), 1, 1);
}

}  // namespace

std::vector<XdmfArray*> referenced_arrays(XdmfArray& array, const std::string& source) {
  if (array.getReadMode() != XdmfArray::Reference) return {};
  if (XdmfSubset* const selection = selection_of(array); selection != nullptr && selection->getReferenceArray()) {
    require_inside(*selection, dimensions_of(*selection->getReferenceArray()), source);
    return {selection->getReferenceArray().get()};
  }
  if (auto* const function = dynamic_cast<XdmfFunction*>(array.getReference().get());
      function != nullptr && function->getExpression() == interleaved) {
    std::vector<XdmfArray*> axes;
    for (const std::string& name : function->getVariableList()) axes.push_back(function->getVariable(name).get());
    const bool are_three = axes.size() == 3 && std::all_of(axes.begin(), axes.end(), [&](XdmfArray* axis) {
                             return product(dimensions_of(*axis)) == product(dimensions_of(*axes.front()));
                           });
    if (!are_three)
      throw scene::bad_input(fmt::format(
          "{}: its points are given as X_Y_Z, but not by three arrays of equal length; write the file again", source));
    return axes;
  }
  throw scene::bad_input(
      fmt::format("{}: it has numbers that are defined as a function of others, which is not supported; write the "
                  "numbers themselves",
                  source));
}

NumberType number_type_of(const XdmfArray& array) {
  const auto type = array.getArrayType();
  if (type == XdmfArrayType::Int8()) return NumberType::int8;
  if (type == XdmfArrayType::UInt8()) return NumberType::uint8;
  if (type == XdmfArrayType::Int16()) return NumberType::int16;
  if (type == XdmfArrayType::UInt16()) return NumberType::uint16;
  if (type == XdmfArrayType::Int32()) return NumberType::int32;
  if (type == XdmfArrayType::UInt32()) return NumberType::uint32;
  if (type == XdmfArrayType::Int64()) return NumberType::int64;
  if (type == XdmfArrayType::Float32()) return NumberType::float32;
  return NumberType::float64;
}

void read_numbers(XdmfArray& array) {
  if (array.isInitialized()) return;
  if (array.getReadMode() != XdmfArray::Reference) return array.read();
  if (XdmfSubset* const selection = selection_of(array)) {
    XdmfArray& all = *selection->getReferenceArray();
    read_numbers(all);
    const Sizes sizes = all.getDimensions();
    const auto type = all.getArrayType();
    if (number_type_of(all) == NumberType::int64)
      fill(array, type, selection->getDimensions(), selected(values_of<std::int64_t>(all), sizes, *selection));
    else  // doubles represent the numbers exactly
      fill(array, type, selection->getDimensions(), selected(values_of<double>(all), sizes, *selection));
    return;
  }
  auto& function = dynamic_cast<XdmfFunction&>(*array.getReference());
  std::vector<double> points;
  for (unsigned axis = 0; axis < 3; ++axis) {
    const std::vector<double> numbers = values_of<double>(*function.getVariable(fmt::format("Val{}", axis)));
    points.resize(3 * numbers.size());
    for (std::size_t k = 0; k < numbers.size(); ++k) points[3 * k + axis] = numbers[k];
  }
  fill(array, XdmfArrayType::Float64(), {static_cast<unsigned>(points.size() / 3), 3}, points);
}

}  // namespace tessera::readers
