#include "io/helper/xdmf_elements.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <sstream>
#include <string>
#include <string_view>

#include "io/mapped_file.hpp"
#include "io/xml_elements.hpp"
#include "scene/error.hpp"
#include "scene/quote.hpp"

namespace tessera::io::helper {
namespace {

/// Counts the words of a <DataItem> whose numbers are in the text.
class InlineNumbers {
 public:
  explicit InlineNumbers(const std::string& source) : source_(source) {}

  void begin(const XmlElement& element) {
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
                      "anew",
                      source_, scene::quote(dimensions_), words_));
    constexpr std::uint64_t most = 10'000'000;  // of libxml2, as Xdmf's library calls it
    if (bytes_ > most)
      throw scene::bad_input(fmt::format(
          "{}: a <DataItem> has {} bytes of numbers in the text, and Xdmf's library takes {} at most; write "
          "its numbers to HDF5 or a binary file",
          source_, bytes_, most));
    dimensions_.clear();
  }

 private:
  const std::string& source_;
  std::string dimensions_;  ///< empty: there is nothing to count
  std::uint64_t words_ = 0, bytes_ = 0;
  bool in_word_ = false;
};

/// What is right by the format's documentation, and an error to its library.
bool is_to_be_rewritten(const XmlElement& element) {
  if (element.find("Reference") != nullptr) return true;
  if (element.name == "Attribute") {
    const std::string* const type = element.find("AttributeType");
    return element.find("Name") == nullptr || element.find("Center") == nullptr ||
           (type != nullptr && *type == "FiniteElementFunction");
  }
  if (element.name == "Time") return element.find("Value") == nullptr;
  if (element.name != "DataItem") return false;
  const std::string *format = element.find("Format"), *type = element.find("NumberType"),
                    *precision = element.find("Precision");
  if (type == nullptr) type = element.find("DataType");
  return format == nullptr || *format == "HDF5" || *format == "xml" || *format == "hdf" || *format == "binary" ||
         (type != nullptr && *type == "UInt" && precision != nullptr && *precision == "8");
}

}  // namespace

XdmfText check_xdmf_elements(const std::filesystem::path& file) {
  const MappedFile mapped(file);
  const std::string source = file.string();
  if (mapped.text().find("<!ENTITY") != std::string_view::npos)
    throw scene::bad_input(fmt::format("{}: it defines entities of its own; write it without", source));
  InlineNumbers numbers(source);
  XdmfText text = XdmfText::plain;
  const auto visit = [&](const XmlElement& element) {
    const std::string* const included = element.name.ends_with("include") ? element.find("href") : nullptr;
    if (included != nullptr && !included->empty() && *included != file.filename())
      throw scene::bad_input(
          fmt::format("{}: it includes another file; have it written as one, with its numbers beside", source));
    if (included != nullptr || is_to_be_rewritten(element)) text = XdmfText::to_be_rewritten;
    numbers.begin(element);
  };
  each_xml_element(mapped.text(), source, visit, [&](std::string_view words) { numbers.add(words); });
  numbers.end();
  return text;
}

}  // namespace tessera::io::helper
