// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "scene/error.hpp"

namespace tessera::io {

/// Maximum nesting depth of elements. Data files are 5 deep; a limit is needed because recursive parsers overflow the
/// stack.
inline constexpr std::size_t most_nested = 256;
scene::Error nested_too_deep(const std::string& source);

/// An opening tag: its name, the names of its parents from the root on, its attributes with entities resolved, and the
/// position in the text after the tag.
struct XmlElement {
  std::string_view name;
  const std::vector<std::string>& parents;
  std::map<std::string, std::string> attributes;
  std::size_t text_at = 0;

  /// Returns the value of an attribute; null if it is absent.
  [[nodiscard]] const std::string* find(const std::string& attribute) const;
};

/// Calls `visit` for each element of a small XML text (a list of files, not a mesh), in order. Errors thrown by `visit`
/// propagate. Throws Error(bad_input, "SOURCE: line N: ...") if the text is not well formed. Text between tags is
/// passed to `visit_text`, if given, in pieces that may be cut anywhere.
void each_xml_element(std::string_view text, const std::string& source,
                      const std::function<void(const XmlElement&)>& visit,
                      const std::function<void(std::string_view)>& visit_text = nullptr);

}  // namespace tessera::io
