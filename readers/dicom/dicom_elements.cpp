// SPDX-License-Identifier: BSD-3-Clause
#include "readers/dicom/dicom_elements.hpp"

#include <gdcmSequenceOfItems.h>

#include <algorithm>
#include <charconv>
#include <chrono>
#include <cmath>
#include <cstring>
#include <string_view>

namespace tessera::readers {
namespace {

std::string_view bytes_of_element(const gdcm::DataSet& data, std::uint16_t group, std::uint16_t element) {
  const gdcm::Tag tag(group, element);
  if (!data.FindDataElement(tag)) return {};
  const gdcm::ByteValue* const value = data.GetDataElement(tag).GetByteValue();
  if (value == nullptr || value->GetPointer() == nullptr) return {};
  return {value->GetPointer(), value->GetLength()};
}

template <class T>
T binary_at(std::string_view bytes, std::size_t at) {
  T value;
  std::memcpy(&value, bytes.data() + at, sizeof(T));
  return value;
}

std::vector<double> numbers_in(std::string_view rest) {
  std::vector<double> numbers;
  while (!rest.empty()) {
    const std::size_t stop = std::min(rest.find('\\'), rest.size());
    std::string_view word = rest.substr(0, stop);
    rest.remove_prefix(std::min(stop + 1, rest.size()));
    word.remove_prefix(std::min(word.find_first_not_of(" +"), word.size()));
    double value = 0;
    if (std::from_chars(word.data(), word.data() + word.size(), value).ec != std::errc() || !std::isfinite(value))
      break;
    numbers.push_back(value);
  }
  return numbers;
}

}  // namespace

std::string dicom_text(const gdcm::DataSet& data, std::uint16_t group, std::uint16_t element) {
  std::string text(bytes_of_element(data, group, element));
  const std::size_t last = text.find_last_not_of(std::string_view(" \0", 2));
  text.resize(last == std::string::npos ? 0 : last + 1);
  return text.substr(std::min(text.find_first_not_of(' '), text.size()));
}

std::vector<double> dicom_numbers(const gdcm::DataSet& data, std::uint16_t group, std::uint16_t element) {
  return numbers_in(dicom_text(data, group, element));
}

std::optional<double> dicom_number(const gdcm::DataSet& data, std::uint16_t group, std::uint16_t element) {
  const std::vector<double> numbers = dicom_numbers(data, group, element);
  return numbers.empty() ? std::nullopt : std::optional(numbers.front());
}

std::vector<std::uint16_t> dicom_shorts(const gdcm::DataSet& data, std::uint16_t group, std::uint16_t element) {
  const std::string_view bytes = bytes_of_element(data, group, element);
  std::vector<std::uint16_t> numbers;
  for (std::size_t at = 0; at + 2 <= bytes.size(); at += 2) numbers.push_back(binary_at<std::uint16_t>(bytes, at));
  return numbers;
}

std::optional<double> dicom_count(const gdcm::DataSet& data, std::uint16_t group, std::uint16_t element) {
  const std::string_view bytes = bytes_of_element(data, group, element);
  if (bytes.size() == 4) return binary_at<std::uint32_t>(bytes, 0);
  if (bytes.size() == 2) return binary_at<std::uint16_t>(bytes, 0);
  return std::nullopt;
}

std::optional<double> dicom_double(const gdcm::DataSet& data, std::uint16_t group, std::uint16_t element) {
  const std::string_view bytes = bytes_of_element(data, group, element);
  if (bytes.size() < 8) return std::nullopt;
  const auto value = binary_at<double>(bytes, 0);
  return std::isfinite(value) ? std::optional(value) : std::nullopt;
}

double dicom_seconds(double clock) {
  const double hours = std::floor(clock / 1e4), minutes = std::floor(clock / 100) - 100 * hours;
  return hours * 3600 + minutes * 60 + std::fmod(clock, 100);
}

std::optional<double> dicom_moment(const std::string& date_and_time) {
  if (date_and_time.size() < 8) return std::nullopt;
  const std::vector<double> date = numbers_in(date_and_time.substr(0, 8)), clock = numbers_in(date_and_time.substr(8));
  if (date.empty()) return std::nullopt;
  const auto digits = static_cast<unsigned>(std::clamp(date.front(), 0.0, 99999999.0));
  const std::chrono::sys_days day = std::chrono::year(static_cast<int>(digits / 10000)) /
                                    std::chrono::month(std::clamp(digits / 100 % 100, 1u, 12u)) /
                                    std::chrono::day(digits % 100);
  return static_cast<double>(day.time_since_epoch().count()) * 86400 +
         (clock.empty() ? 0 : dicom_seconds(clock.front()));
}

std::vector<gdcm::DataSet> dicom_items(const gdcm::DataSet& data, std::uint16_t group, std::uint16_t element) {
  const gdcm::Tag tag(group, element);
  std::vector<gdcm::DataSet> items;
  if (!data.FindDataElement(tag)) return items;
  const gdcm::SmartPointer<gdcm::SequenceOfItems> sequence = data.GetDataElement(tag).GetValueAsSQ();
  if (!sequence) return items;
  for (std::size_t k = 1; k <= sequence->GetNumberOfItems(); ++k)
    items.push_back(sequence->GetItem(k).GetNestedDataSet());
  return items;
}

}  // namespace tessera::readers
