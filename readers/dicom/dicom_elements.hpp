// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <gdcmDataSet.h>

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

/// Values of DICOM elements by their tag. Missing or non-numeric elements have no value, which is never an error.
namespace tessera::readers {

/// A text element without padding blanks; empty if it is missing.
std::string dicom_text(const gdcm::DataSet& data, std::uint16_t group, std::uint16_t element);

/// Decimal strings separated by backslashes; stops before a word that is not a number.
std::vector<double> dicom_numbers(const gdcm::DataSet& data, std::uint16_t group, std::uint16_t element);
std::optional<double> dicom_number(const gdcm::DataSet& data, std::uint16_t group, std::uint16_t element);

/// Binary elements: 16-bit integers (US), one integer of 16 or 32 bits (US, UL), and one of type FD.
std::vector<std::uint16_t> dicom_shorts(const gdcm::DataSet& data, std::uint16_t group, std::uint16_t element);
std::optional<double> dicom_count(const gdcm::DataSet& data, std::uint16_t group, std::uint16_t element);
std::optional<double> dicom_double(const gdcm::DataSet& data, std::uint16_t group, std::uint16_t element);

/// Converts HHMMSS.FFFFFF to seconds.
double dicom_seconds(double clock);
/// Converts YYYYMMDDHHMMSS.FFFFFF to a number that increases with time.
std::optional<double> dicom_moment(const std::string& date_and_time);

/// The items of a sequence; empty if the element is not a sequence.
std::vector<gdcm::DataSet> dicom_items(const gdcm::DataSet& data, std::uint16_t group, std::uint16_t element);

/// Sort key of images at one position.
struct DicomTime {
  double value = 0;
  double unit = 0;  ///< in seconds; 0: the number is only a count
};

}  // namespace tessera::readers
