#include "io/json_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <set>
#include <vector>

#include "io/text_file.hpp"
#include "scene/error.hpp"

namespace tessera::io {
namespace {

/// The part of nlohmann's message that says what is wrong, on one line and free of foreign bytes:
/// "[json.exception.parse_error.101] parse error at line 1, column 2: syntax error while ... - WHAT; last read: '...'"
std::string reason(std::string message) {
  if (const auto last = message.find("; last read"); last != std::string::npos) message.resize(last);
  if (const auto dash = message.rfind(" - "); dash != std::string::npos) message.erase(0, dash + 3);
  if (const auto bracket = message.find("] "); bracket != std::string::npos) message.erase(0, bracket + 2);
  if (message.size() > 120) message.resize(120);
  for (char& c : message)
    if (c < 0x20 || c > 0x7e) c = '?';
  return message;
}

std::string place(std::string_view text, std::size_t byte) {
  const std::string_view before = text.substr(0, byte > 0 ? byte - 1 : 0);  // nlohmann counts bytes from 1
  const auto line = 1 + std::count(before.begin(), before.end(), '\n');
  const std::size_t begin_of_line = before.rfind('\n') + 1;  // npos + 1 is 0
  return fmt::format("line {}, column {}", line, before.size() - begin_of_line + 1);
}

}  // namespace

scene::Error not_json(std::string_view text, const std::string& source, std::size_t byte, const std::string& message) {
  return scene::bad_input(fmt::format("{}: {}: not valid JSON ({}); mend it or export it again", source,
                                      place(text, byte), reason(message)));
}

nlohmann::json parse_json(std::string_view text, const std::string& source) {
  using nlohmann::json;
  constexpr int deepest = 64;
  std::vector<std::set<std::string>> keys;  // of the objects that are open, outermost first
  const auto watch = [&](int depth, json::parse_event_t event, json& parsed) {
    if (depth > deepest)
      throw scene::bad_input(
          fmt::format("{}: nested more than {} levels deep; this is no file of ours", source, deepest));
    if (event == json::parse_event_t::object_start) {
      keys.emplace_back();
    } else if (event == json::parse_event_t::object_end) {
      keys.pop_back();
    } else if (event == json::parse_event_t::key) {
      const auto& key = parsed.get_ref<const std::string&>();
      if (!keys.back().insert(key).second)
        throw scene::bad_input(fmt::format("{}: {} stands twice in one object; keep one", source, quote(key)));
    }
    return true;
  };
  try {
    return json::parse(text.begin(), text.end(), watch);
  } catch (const json::parse_error& error) {
    throw not_json(text, source, error.byte, error.what());
  } catch (const json::exception& error) {
    throw scene::bad_input(
        fmt::format("{}: not valid JSON ({}); mend it or export it again", source, reason(error.what())));
  }
}

}  // namespace tessera::io
