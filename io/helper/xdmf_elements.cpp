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
    if (element.name != "DataItem" || dimensions == nullptr || (format != nullptr && *format != "XML") ||
        (kind != nullptr && *kind != "Uniform"))
      return;
    dimensions_ = *dimensions;
    words_ = 0, in_word_ = false;
  }

  void add(std::string_view text) {
    if (dimensions_.empty()) return;
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
    dimensions_.clear();
  }

 private:
  const std::string& source_;
  std::string dimensions_;  ///< empty: there is nothing to count
  std::uint64_t words_ = 0;
  bool in_word_ = false;
};

}  // namespace

void check_xdmf_elements(const std::filesystem::path& file) {
  const MappedFile mapped(file);
  const std::string source = file.string();
  if (mapped.text().find("<!ENTITY") != std::string_view::npos)
    throw scene::bad_input(fmt::format("{}: it defines entities of its own; write it without", source));
  InlineNumbers numbers(source);
  const auto visit = [&](const XmlElement& element) {
    if (element.name.ends_with("include") && element.find("href") != nullptr && !element.find("href")->empty())
      throw scene::bad_input(
          fmt::format("{}: it includes another file; have it written as one, with its numbers beside", source));
    if (element.find("Reference") != nullptr)
      throw scene::bad_input(
          fmt::format("{}: its <{}> stands for another by Reference, which Xdmf's library does not know; write it with "
                      "<xi:include>, or save it as .vtu in ParaView",
                      source, element.name));
    numbers.begin(element);
  };
  each_xml_element(mapped.text(), source, visit, [&](std::string_view text) { numbers.add(text); });
  numbers.end();
}

}  // namespace tessera::io::helper
