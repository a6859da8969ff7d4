// SPDX-License-Identifier: BSD-3-Clause
#include "io/vtk/vtk_xml_elements.hpp"

#include <expat.h>
#include <fmt/format.h>

#include <algorithm>
#include <exception>
#include <memory>
#include <new>
#include <string_view>

#include "io/text/xml_elements.hpp"
#include "scene/error.hpp"
#include "system/positional_file.hpp"

namespace tessera::io {
namespace {

/// Passes a file to the parser tag by tag, so that the position of each tag's end is known.
class ElementWalk {
 public:
  /// Elements are discarded when the next one begins, unless `keeps`.
  ElementWalk(const system::PositionalFile& file, const std::string& source, bool keeps)
      : file_(file),
        source_(source),
        keeps_(keeps),
        size_(file.size()),
        parser_(XML_ParserCreate(nullptr), &XML_ParserFree) {
    if (!parser_) throw std::bad_alloc();
    XML_SetUserData(parser_.get(), this);
    XML_SetElementHandler(parser_.get(), on_start, on_end);
#if XML_MAJOR_VERSION > 2 || (XML_MAJOR_VERSION == 2 && XML_MINOR_VERSION >= 6)
    XML_SetReparseDeferralEnabled(parser_.get(), XML_FALSE);  // events are reported as soon as their tags end
#endif
  }

  std::vector<VtkXmlElement> walk() {
    for (std::string_view view = window(); !view.empty(); view = window()) {
      if (in_array_) {
        const std::size_t numbers = std::min(view.find('<'), view.size());
        is_blank_ = is_blank_ && view.substr(0, numbers).find_first_not_of(" \n\r\t") == std::string_view::npos;
        at_ += numbers;
        if (numbers == view.size()) continue;
        elements_.back().text_end = at_;
        elements_.back().has_text_behind_tags = next_is('!') || (is_blank_ && !next_is('/'));
        in_array_ = false;
        continue;
      }
      const std::size_t end = view.find('>');
      const std::string_view part = view.substr(0, end == std::string_view::npos ? end : end + 1);
      is_new_ = false;
      parse(part, false);
      at_ += part.size();
      if (is_new_) {
        VtkXmlElement& element = elements_.back();
        element.text_at = element.text_end = at_;
        if (element.name == "AppendedData") return std::move(elements_);
        in_array_ = is_blank_ = is_open_ && (element.name == "DataArray" || element.name == "Array");
      }
    }
    parse("", true);
    return std::move(elements_);
  }

 private:
  /// The callbacks are called from C, so they must not throw.
  static void XMLCALL on_start(void* user, const XML_Char* name, const XML_Char** attributes) {
    ElementWalk& walk = *static_cast<ElementWalk*>(user);
    if (walk.fault_) return;
    try {
      if (walk.depth_ >= most_nested) throw nested_too_deep(walk.source_);
      VtkXmlElement element{name, walk.depth_++};
      if (!walk.keeps_) walk.elements_.clear();
      for (; *attributes != nullptr; attributes += 2) element.attributes.emplace(attributes[0], attributes[1]);
      walk.elements_.push_back(std::move(element));
      walk.is_open_ = walk.is_new_ = true;
    } catch (...) {
      walk.fault_ = std::current_exception();
      XML_StopParser(walk.parser_.get(), XML_FALSE);
    }
  }

  static void XMLCALL on_end(void* user, const XML_Char* /*name*/) {
    ElementWalk& walk = *static_cast<ElementWalk*>(user);
    if (walk.depth_ > 0) --walk.depth_;
    walk.is_open_ = false;
  }

  void parse(std::string_view part, bool last) {
    const XML_Status status = XML_Parse(parser_.get(), part.data(), static_cast<int>(part.size()), last);
    if (fault_) std::rethrow_exception(fault_);
    if (status != XML_STATUS_OK)
      throw scene::bad_input(fmt::format("{}: near byte {}: {}; the file is truncated or damaged, export it again",
                                         source_, at_, XML_ErrorString(XML_GetErrorCode(parser_.get()))));
  }

  /// Whether the next character of the tag at at_ is `c`.
  [[nodiscard]] bool next_is(char c) const {
    char next = '\0';
    if (size_ - at_ > 1) file_.read(at_ + 1, reinterpret_cast<std::byte*>(&next), 1);
    return next == c;
  }

  /// Returns the text of the file from at_ on; empty at the end of the file.
  std::string_view window() {
    constexpr std::uint64_t most = 256 << 10;
    if (at_ >= window_at_ + text_.size()) {
      window_at_ = at_;
      text_.resize(std::min(most, size_ - std::min(at_, size_)));
      file_.read(at_, reinterpret_cast<std::byte*>(text_.data()), text_.size());
    }
    return std::string_view(text_).substr(at_ - window_at_);
  }

  const system::PositionalFile& file_;
  const std::string& source_;
  bool keeps_;
  std::uint64_t size_;
  std::unique_ptr<XML_ParserStruct, decltype(&XML_ParserFree)> parser_;
  std::string text_;
  std::uint64_t window_at_ = 0, at_ = 0;
  std::vector<VtkXmlElement> elements_;
  std::size_t depth_ = 0;
  bool is_open_ = false;   ///< the end tag of the last element has not been parsed
  bool is_new_ = false;    ///< the last element began in the text parsed last
  bool in_array_ = false;  ///< numbers are being skipped up to the next tag
  bool is_blank_ = false;  ///< no number has been found yet
  std::exception_ptr fault_;
};

}  // namespace

std::string VtkXmlElement::word(const std::string& attribute, const std::string& otherwise) const {
  const auto found = attributes.find(attribute);
  return found == attributes.end() ? otherwise : found->second;
}

std::vector<VtkXmlElement> vtk_xml_elements(const system::PositionalFile& file, const std::string& source) {
  return ElementWalk(file, source, true).walk();
}

void require_vtk_xml_form(const system::PositionalFile& file, const std::string& source) {
  ElementWalk(file, source, false).walk();
}

}  // namespace tessera::io
