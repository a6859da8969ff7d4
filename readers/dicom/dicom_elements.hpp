// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <gdcmDataSet.h>

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

/// Values of DICOM elements by their tag. What is missing or is not a number is none, never an error.
namespace tessera::readers {

/// A text element, without the blanks that fill it up; empty if there is none.
std::string dicom_text(const gdcm::DataSet& data, std::uint16_t group, std::uint16_t element);

/// Decimal strings, with backslashes between; fewer than there are words if one is no number.
std::vector<double> dicom_numbers(const gdcm::DataSet& data, std::uint16_t group, std::uint16_t element);
std::optional<double> dicom_number(const gdcm::DataSet& data, std::uint16_t group, std::uint16_t element);

/// Binary elements: whole numbers of 16 bits (US), one of 16 or 32 (US, UL), and one of type FD.
std::vector<std::uint16_t> dicom_shorts(const gdcm::DataSet& data, std::uint16_t group, std::uint16_t element);
std::optional<double> dicom_count(const gdcm::DataSet& data, std::uint16_t group, std::uint16_t element);
std::optional<double> dicom_double(const gdcm::DataSet& data, std::uint16_t group, std::uint16_t element);

/// Seconds of HHMMSS.FFFFFF.
double dicom_seconds(double clock);
/// Of YYYYMMDDHHMMSS.FFFFFF, a number that is larger the later it is.
std::optional<double> dicom_moment(const std::string& date_and_time);

/// The items of a sequence; none if it is none.
std::vector<gdcm::DataSet> dicom_items(const gdcm::DataSet& data, std::uint16_t group, std::uint16_t element);

/// What orders pictures of one place.
struct DicomTime {
  double value = 0;
  double unit = 0;  ///< in seconds; 0: a number that counts
};

}  // namespace tessera::readers
