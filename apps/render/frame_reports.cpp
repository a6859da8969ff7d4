// SPDX-License-Identifier: BSD-3-Clause
#include "apps/render/frame_reports.hpp"

#include <nlohmann/json.hpp>
#include <string_view>

namespace tessera::apps {
namespace {

using Json = nlohmann::ordered_json;

/// Converts to text. Text that is not UTF-8, such as a file name, is replaced, since JSON must be UTF-8. If `indent` is
/// negative, the text is one line.
std::string text_of(const Json& json, int indent) {
  return json.dump(indent, ' ', false, Json::error_handler_t::replace);
}

constexpr int indent = 2;

std::string indented(const std::string& text, std::size_t by) {
  const std::string space(by, ' ');
  std::string result = space;
  for (const char c : text) {
    result += c;
    if (c == '\n') result += space;
  }
  return result;
}

}  // namespace

void FrameReports::add(const Json& frame) {
  if (!kept_) return;
  frames_ += text_of(frame, -1) + '\n';
}

std::string FrameReports::text(const Json& report) const {
  std::string all = text_of(report, indent);
  all.resize(all.size() - 2);  // removes the newline and the bracket at the end
  all += ",\n  \"frames\": [";
  for (std::size_t at = 0; at < frames_.size();) {
    const std::size_t end = frames_.find('\n', at);
    all += at == 0 ? "\n" : ",\n";
    const std::string_view frame = std::string_view(frames_).substr(at, end - at);
    all += indented(text_of(Json::parse(frame), indent), 4);
    at = end + 1;
  }
  return all += frames_.empty() ? "]\n}\n" : "\n  ]\n}\n";
}

}  // namespace tessera::apps
