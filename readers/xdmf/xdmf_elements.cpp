// SPDX-License-Identifier: BSD-3-Clause
#include "readers/xdmf/xdmf_elements.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <initializer_list>
#include <sstream>
#include <string>
#include <string_view>

#include "io/files/whole_file.hpp"
#include "io/text/xml_elements.hpp"
#include "scene/error.hpp"
#include "tessera/program/text.hpp"

namespace tessera::readers {
namespace {

/// Counts the words of a <DataItem> whose numbers are in the text.
class InlineNumbers {
 public:
  explicit InlineNumbers(const std::string& source) : source_(source) {}

  void begin(const io::XmlElement& element) {
    end();
    const std::string *format = element.find("Format"), *kind = element.find("ItemType"),
                      *dimensions = element.find("Dimensions");
    if (element.name != "DataItem" || dimensions == nullptr || element.find("Reference") != nullptr ||
        (format != nullptr && *format != "XML") || (kind != nullptr && *kind != "Uniform"))
      return;
    dimensions_ = *dimensions;
    words_ = bytes_ = 0, in_word_ = false;
  }

  void add(std::string_view text) {
    if (dimensions_.empty()) return;
    bytes_ += text.size();
    for (const char c : text) {
      const bool is_blank = c == ' ' || c == '\n' || c == '\t' || c == '\r';
      if (!is_blank && !in_word_) ++words_;
      in_word_ = !is_blank;
    }
  }

  void end() {
    if (dimensions_.empty()) return;
    double expected = 1, side = 0;
    std::string text = dimensions_;
    std::replace(text.begin(), text.end(), ',', ' ');
    for (std::istringstream sides(text); sides >> side;) expected *= side;
    if (expected != static_cast<double>(words_))
      throw scene::bad_input(
          fmt::format("{}: a <DataItem> of the dimensions {} holds {} numbers; it is truncated or damaged, write it "
                      "again",
                      source_, quote(dimensions_), words_));
    constexpr std::uint64_t most = 10'000'000;  // limit of libxml2 with the options of Xdmf's library
    if (bytes_ > most)
      throw scene::bad_input(
          fmt::format("{}: a <DataItem> has {} bytes of numbers in the text, but Xdmf's library reads {} at most; "
                      "write its numbers to HDF5 or a binary file",
                      source_, bytes_, most));
    dimensions_.clear();
  }

 private:
  const std::string& source_;
  std::string dimensions_;  ///< empty: there is nothing to count
  std::uint64_t words_ = 0, bytes_ = 0;
  bool in_word_ = false;
};

/// Returns the value of the first of these attributes that exists.
std::string word(const io::XmlElement& element, std::initializer_list<const char*> names) {
  for (const char* name : names)
    if (const std::string* const value = element.find(name)) return *value;
  return "";
}

/// Throws for items that Xdmf's library would misinterpret.
void check_item(const io::XmlElement& element, const std::string& source) {
  if (element.name != "DataItem") return;
  if (upper_case(word(element, {"ItemType"})).starts_with("COORDINATE"))
    throw scene::bad_input(
        fmt::format("{}: a <DataItem> of the type {} selects single numbers, which is not supported; write these "
                    "numbers themselves, or select them as a HyperSlab",
                    source, quote(word(element, {"ItemType"}))));
  if (upper_case(word(element, {"Format"})) != "BINARY") return;
  const std::string type = upper_case(word(element, {"NumberType", "DataType"})), bytes = word(element, {"Precision"});
  const bool is_known = bytes.empty() || bytes == "4" || bytes == "8" ||
                        ((bytes == "1" || bytes == "2") && type != "FLOAT" && !type.empty());
  if (!is_known)
    throw scene::bad_input(
        fmt::format("{}: a <DataItem> has binary numbers of the unsupported Precision {}; write floats of 4 or 8 bytes "
                    "or integers of 1, 2, 4 or 8",
                    source, quote(bytes)));
}

/// Whether the element is valid according to the format's documentation, but the library cannot read it.
bool is_to_be_rewritten(const io::XmlElement& element) {
  if (element.find("Reference") != nullptr) return true;
  if (element.name == "Attribute") {
    const std::string* const type = element.find("AttributeType");
    return element.find("Name") == nullptr || element.find("Center") == nullptr ||
           (type != nullptr && *type == "FiniteElementFunction");
  }
  if (element.name == "Time") return element.find("Value") == nullptr;
  if (element.name == "Topology")
    return element.find(base_offset) != nullptr ||
           (element.find("Dimensions") == nullptr && is_structured(word(element, {"TopologyType", "Type"})));
  if (element.name == "Geometry") return is_of_three_arrays(word(element, {"GeometryType", "Type"}));
  if (element.name != "DataItem") return false;
  const std::string* const format = element.find("Format");
  return format == nullptr || *format == "HDF5" || *format == "xml" || *format == "hdf" || *format == "binary" ||
         is_selection(word(element, {"ItemType"})) ||
         library_type(word(element, {"NumberType", "DataType"}), word(element, {"Precision"}));
}

}  // namespace

bool is_structured(const std::string& topology_type) {
  const std::string type = upper_case(topology_type);
  return type == "3DCORECTMESH" || type == "3DRECTMESH" || type == "3DSMESH";
}

bool is_of_three_arrays(const std::string& geometry_type) { return upper_case(geometry_type) == "X_Y_Z"; }

bool is_selection(const std::string& item_type) { return upper_case(item_type) == "HYPERSLAB"; }

std::optional<std::string> library_type(const std::string& number_type, const std::string& precision) {
  const std::string type = upper_case(number_type), sign = type == "UINT" ? "U" : "";
  if (type.empty() && precision == "8") return "Float";  // otherwise the library would assume 4 bytes
  if (type != "INT" && type != "UINT") return std::nullopt;
  if (precision == "1") return sign + "Char";
  if (precision == "2") return sign + "Short";
  if (type == "UINT" && precision == "8") return "Int";  // the library lacks this type, and would read 4 of the 8 bytes
  return std::nullopt;
}

XdmfText check_xdmf_elements(const std::filesystem::path& file) {
  const io::WholeFile mapped(file);
  const std::string source = file.string();
  if (mapped.text().find("<!ENTITY") != std::string_view::npos)
    throw scene::bad_input(
        fmt::format("{}: it defines its own XML entities, which is not supported; write it without them", source));
  InlineNumbers numbers(source);
  XdmfText text = XdmfText::plain;
  const auto visit = [&](const io::XmlElement& element) {
    const std::string* const included = element.name.ends_with("include") ? element.find("href") : nullptr;
    if (included != nullptr && !included->empty() && *included != file.filename())
      throw scene::bad_input(
          fmt::format("{}: it includes another file, which is not supported; write both as one file", source));
    check_item(element, source);
    if (included != nullptr || is_to_be_rewritten(element)) text = XdmfText::to_be_rewritten;
    numbers.begin(element);
  };
  io::each_xml_element(mapped.text(), source, visit, [&](std::string_view words) { numbers.add(words); });
  numbers.end();
  return text;
}

}  // namespace tessera::readers
