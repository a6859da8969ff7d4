// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <gdcmDataSet.h>

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

/// Functions that return the values of DICOM elements, given their tag. For a missing or non-numeric element they
/// return no value, or an empty text or list, without an error.
namespace tessera::readers {

/// Returns a text element without padding blanks; empty if the element is missing.
std::string dicom_text(const gdcm::DataSet& data, std::uint16_t group, std::uint16_t element);

/// Parses decimal strings separated by backslashes. Stops before a word that is not a number.
std::vector<double> dicom_numbers(const gdcm::DataSet& data, std::uint16_t group, std::uint16_t element);
std::optional<double> dicom_number(const gdcm::DataSet& data, std::uint16_t group, std::uint16_t element);

/// Binary elements: a list of 16-bit integers (US), one integer of 16 or 32 bits (US, UL), and one number of type FD.
std::vector<std::uint16_t> dicom_shorts(const gdcm::DataSet& data, std::uint16_t group, std::uint16_t element);
std::optional<double> dicom_count(const gdcm::DataSet& data, std::uint16_t group, std::uint16_t element);
std::optional<double> dicom_double(const gdcm::DataSet& data, std::uint16_t group, std::uint16_t element);

/// Converts HHMMSS.FFFFFF to seconds.
double dicom_seconds(double clock);
/// Converts YYYYMMDDHHMMSS.FFFFFF to a number that increases with the time.
std::optional<double> dicom_moment(const std::string& date_and_time);

/// Returns the items of a sequence; empty if the element is not a sequence.
std::vector<gdcm::DataSet> dicom_items(const gdcm::DataSet& data, std::uint16_t group, std::uint16_t element);

/// The key by which images at one position are sorted.
struct DicomTime {
  double value = 0;
  double unit = 0;  ///< unit of the number in seconds; 0: the number is only a count
};

}  // namespace tessera::readers
