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
  std::size_t depth = 0;  ///< of the root 0
  std::map<std::string, std::string> attributes{};
  std::uint64_t text_at = 0;          ///< behind its opening tag, in the file
  std::uint64_t text_end = 0;         ///< of a DataArray or Array: at the tag that comes next; of others not set
  bool has_text_behind_tags = false;  ///< of these: a comment or an element comes before or between the numbers

  /// An attribute, or `otherwise`.
  [[nodiscard]] std::string word(const std::string& attribute, const std::string& otherwise = "") const;
  [[nodiscard]] bool has(const std::string& attribute) const { return attributes.contains(attribute); }
};

/// The elements of a file up to AppendedData, with which the XML ends, or its own end. The numbers of arrays are passed
/// over, not parsed as XML. Throws Error(bad_input, "SOURCE: ...") if the rest is not well formed, or elements are
/// nested deeper than most_nested (io/text/xml_elements.hpp).
std::vector<VtkXmlElement> vtk_xml_elements(const system::PositionalFile& file, const std::string& source);

/// For files that VTK's reader parses, which goes as deep as they do: throws as vtk_xml_elements().
void require_vtk_xml_form(const system::PositionalFile& file, const std::string& source);

}  // namespace tessera::io
