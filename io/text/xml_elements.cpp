// SPDX-License-Identifier: BSD-3-Clause
#include "io/text/xml_elements.hpp"

#include <expat.h>
#include <fmt/format.h>

#include <algorithm>
#include <exception>
#include <limits>
#include <memory>

#include "scene/error.hpp"

namespace tessera::io {
namespace {

/// The callbacks are called from C, so nothing may be thrown: the first error is stored and the parser stopped.
struct Walk {
  XML_Parser parser;
  const std::string& source;
  const std::function<void(const XmlElement&)>& visit;
  const std::function<void(std::string_view)>& visit_text;
  std::vector<std::string> parents{};
  std::exception_ptr fault{};
};

void XMLCALL on_start(void* user, const XML_Char* name, const XML_Char** attributes) {
  Walk& walk = *static_cast<Walk*>(user);
  if (walk.fault) return;
  try {
    if (walk.parents.size() >= most_nested) throw nested_too_deep(walk.source);
    XmlElement element{name, walk.parents, {}};
    element.text_at = static_cast<std::size_t>(XML_GetCurrentByteIndex(walk.parser)) +
                      static_cast<std::size_t>(XML_GetCurrentByteCount(walk.parser));
    for (; *attributes != nullptr; attributes += 2) element.attributes.emplace(attributes[0], attributes[1]);
    walk.visit(element);
    walk.parents.emplace_back(name);
  } catch (...) {
    walk.fault = std::current_exception();
    XML_StopParser(walk.parser, XML_FALSE);
  }
}

void XMLCALL on_end(void* user, const XML_Char* /*name*/) {
  Walk& walk = *static_cast<Walk*>(user);
  // If parsing is stopped at the start event of an empty element, expat still sends the end event.
  if (!walk.fault) walk.parents.pop_back();
}

void XMLCALL on_text(void* user, const XML_Char* text, int length) {
  Walk& walk = *static_cast<Walk*>(user);
  if (walk.fault) return;
  try {
    walk.visit_text({text, static_cast<std::size_t>(length)});
  } catch (...) {
    walk.fault = std::current_exception();
    XML_StopParser(walk.parser, XML_FALSE);
  }
}

}  // namespace

scene::Error nested_too_deep(const std::string& source) {
  return scene::bad_input(
      fmt::format("{}: its elements are nested more than {} deep; the file is damaged, export it "
                  "again",
                  source, most_nested));
}

const std::string* XmlElement::find(const std::string& attribute) const {
  const auto found = attributes.find(attribute);
  return found == attributes.end() ? nullptr : &found->second;
}

void each_xml_element(std::string_view text, const std::string& source,
                      const std::function<void(const XmlElement&)>& visit,
                      const std::function<void(std::string_view)>& visit_text) {
  const std::unique_ptr<XML_ParserStruct, decltype(&XML_ParserFree)> parser(XML_ParserCreate(nullptr), &XML_ParserFree);
  if (!parser) throw std::bad_alloc();
  Walk walk{parser.get(), source, visit, visit_text};
  XML_SetUserData(parser.get(), &walk);
  XML_SetElementHandler(parser.get(), on_start, on_end);
  if (visit_text) XML_SetCharacterDataHandler(parser.get(), on_text);
  constexpr std::size_t chunk = 1 << 20;  // expat counts bytes in int
  for (std::size_t at = 0;; at += chunk) {
    const std::string_view part = text.substr(std::min(at, text.size()), chunk);
    const bool last = at + chunk >= text.size();
    const XML_Status status = XML_Parse(parser.get(), part.data(), static_cast<int>(part.size()), last);
    if (walk.fault) std::rethrow_exception(walk.fault);
    if (status != XML_STATUS_OK)
      throw scene::bad_input(fmt::format("{}: line {}: {}; the file is truncated or damaged, write it again", source,
                                         XML_GetCurrentLineNumber(parser.get()),
                                         XML_ErrorString(XML_GetErrorCode(parser.get()))));
    if (last) return;
  }
}

}  // namespace tessera::io
