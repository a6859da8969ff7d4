// SPDX-License-Identifier: BSD-3-Clause
#include "io/text/json_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <utility>
#include <vector>

#include "io/text/text_file.hpp"
#include "scene/error.hpp"
#include "tessera/program/text.hpp"

namespace tessera::io {
namespace {

using nlohmann::json;

/// Returns the part of nlohmann's message that states the error, on one line and without bytes of the text:
/// "[json.exception.parse_error.101] parse error at line 1, column 2: syntax error while ... - WHAT; last read: '...'"
std::string reason(std::string message) {
  if (const auto last = message.find("; last read"); last != std::string::npos) message.resize(last);
  if (const auto dash = message.rfind(" - "); dash != std::string::npos) message.erase(0, dash + 3);
  if (const auto bracket = message.find("] "); bracket != std::string::npos) message.erase(0, bracket + 2);
  return printable_ascii(std::string_view(message).substr(0, 120));
}

std::string place(std::string_view text, std::size_t byte) {
  const std::string_view before = text.substr(0, byte > 0 ? byte - 1 : 0);  // nlohmann counts bytes from 1
  const auto line = 1 + std::count(before.begin(), before.end(), '\n');
  const std::size_t begin_of_line = before.rfind('\n') + 1;  // npos + 1 is 0
  return fmt::format("line {}, column {}", line, before.size() - begin_of_line + 1);
}

/// Builds the values of a text in linear time. The library's own parser with a callback takes quadratic time, because
/// it visits all elements of an array or object at the end of each one.
class Builder final : public nlohmann::json_sax<nlohmann::json> {
 public:
  Builder(std::string_view text, const std::string& source, std::size_t most_values)
      : text_(text), source_(source), most_values_(most_values) {}

  [[nodiscard]] json take() { return std::move(root_); }

  bool null() override { return add(nullptr); }
  bool boolean(bool value) override { return add(value); }
  bool number_integer(number_integer_t value) override { return add(value); }
  bool number_unsigned(number_unsigned_t value) override { return add(value); }
  bool number_float(number_float_t value, const string_t& /*text*/) override { return add(value); }
  bool string(string_t& value) override { return add(std::move(value)); }
  bool binary(binary_t& /*value*/) override { return false; }  // JSON texts do not contain binary values
  bool start_object(std::size_t /*elements*/) override { return open(json::object()); }
  bool start_array(std::size_t /*elements*/) override { return open(json::array()); }
  bool end_object() override { return close(); }
  bool end_array() override { return close(); }

  bool key(string_t& name) override {
    const auto [member, is_new] = open_.back()->get_ref<json::object_t&>().try_emplace(name);
    if (!is_new)
      throw scene::bad_input(fmt::format("{}: {} is given twice in one object; keep one", source_, quote(name)));
    member_ = &member->second;
    return true;
  }

  bool parse_error(std::size_t byte, const std::string& /*token*/, const nlohmann::detail::exception& error) override {
    if (dynamic_cast<const json::parse_error*>(&error) != nullptr) throw not_json(text_, source_, byte, error.what());
    throw scene::bad_input(
        fmt::format("{}: not valid JSON ({}); correct it or export it again", source_, reason(error.what())));
  }

 private:
  json& place(json&& value) {
    if (++values_ > most_values_)
      throw scene::bad_input(fmt::format("{}: it has more than {} values; give fewer", source_, most_values_));
    if (open_.empty()) return root_ = std::move(value);
    if (open_.back()->is_object()) return *member_ = std::move(value);
    return open_.back()->get_ref<json::array_t&>().emplace_back(std::move(value));
  }
  bool add(json&& value) {
    place(std::move(value));
    return true;
  }
  bool open(json&& value) {
    constexpr std::size_t deepest = 64;
    if (open_.size() == deepest)
      throw scene::bad_input(fmt::format(
          "{}: its values are nested more than {} levels deep, unlike those of Tessera's files; give another file",
          source_, deepest));
    open_.push_back(&place(std::move(value)));  // the address of a value is stable until the value is closed
    return true;
  }
  bool close() {
    open_.pop_back();
    return true;
  }

  std::string_view text_;
  const std::string& source_;
  std::size_t most_values_, values_ = 0;
  json root_;
  std::vector<json*> open_;  ///< arrays and objects, outermost first
  json* member_ = nullptr;   ///< in the innermost object: the member whose value is parsed next
};

}  // namespace

scene::Error not_json(std::string_view text, const std::string& source, std::size_t byte, const std::string& message) {
  return scene::bad_input(fmt::format("{}: {}: not valid JSON ({}); correct it or export it again", source,
                                      place(text, byte), reason(message)));
}

nlohmann::json parse_json(std::string_view text, const std::string& source, std::size_t most_values) {
  Builder builder(text, source, most_values);
  nlohmann::json::sax_parse(text.begin(), text.end(), &builder);
  return builder.take();
}

}  // namespace tessera::io
