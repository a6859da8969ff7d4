// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace tessera::system {
class PositionalFile;
}

namespace tessera::io {

/// An element of a VTK XML file. Elements are listed in the order of their opening tags.
struct VtkXmlElement {
  std::string name;
  std::size_t depth = 0;  ///< 0 for the root
  std::map<std::string, std::string> attributes{};
  std::uint64_t text_at = 0;          ///< position in the file after its opening tag
  std::uint64_t text_end = 0;         ///< for a DataArray or Array: position of the next tag; not set for others
  bool has_text_behind_tags = false;  ///< a comment or element precedes or interrupts an array's numbers

  /// Returns the value of an attribute, or `otherwise` if it is absent.
  [[nodiscard]] std::string word(const std::string& attribute, const std::string& otherwise = "") const;
  [[nodiscard]] bool has(const std::string& attribute) const { return attributes.contains(attribute); }
};

/// Returns the elements of a file up to AppendedData, where the XML ends, or up to the end of the file. The numbers of
/// arrays are skipped, not parsed as XML. Throws Error(bad_input, "SOURCE: ...") if the rest is not well formed, or if
/// elements are nested deeper than most_nested (io/text/xml_elements.hpp).
std::vector<VtkXmlElement> vtk_xml_elements(const system::PositionalFile& file, const std::string& source);

/// Throws like vtk_xml_elements(). Called for files that VTK's reader parses, because that reader recurses as deep as
/// the elements are nested.
void require_vtk_xml_form(const system::PositionalFile& file, const std::string& source);

}  // namespace tessera::io
