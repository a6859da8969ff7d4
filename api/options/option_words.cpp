// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <stdexcept>

#include "api/options/argument_values.hpp"
#include "api/options/setting_name.hpp"
#include "tessera/error.hpp"
#include "tessera/program/options.hpp"
#include "tessera/program/text.hpp"

namespace tessera {
inline namespace v0_1 {
namespace {

constexpr Trait any_command = Trait::render | Trait::serve | Trait::info | Trait::convert | Trait::generate |
                              Trait::chart | Trait::timing | Trait::formats | Trait::presets | Trait::help |
                              Trait::completion;

/// Whether a setting's name may be an option of some command.
bool is_setting(std::string_view name) {
  std::string option(name);
  std::ranges::replace(option, '_', '-');
  if (name.find('-') != std::string_view::npos) return false;
  const OptionRow* const row = find_option(any_command, option);
  return row != nullptr && !row->is(Trait::positional);
}

/// Whether a setting's name may follow the text `before`: the name must be a separate word, neither part of a file's
/// name nor quoted.
bool may_precede(std::string_view before) { return before.empty() || before.back() == ' ' || before.back() == '('; }
bool may_follow(std::string_view after) {
  return after.empty() || std::string_view(" ,;:)=").find(after.front()) != std::string_view::npos;
}

/// Applies `parse` to the word, if there is one.
template <class Parse>
auto parsed(const OptionWords& words, std::string_view name, const Parse& parse)
    -> std::optional<decltype(parse(std::string(), std::string()))> {
  if (!words.given(name)) return std::nullopt;
  return parse(api::setting_name(name), words.word(name));
}

}  // namespace

bool OptionRow::has_name(std::string_view name) const {
  for (std::string_view rest = names; !rest.empty();) {
    const std::string_view each = rest.substr(0, rest.find(','));
    if (each == name) return true;
    rest.remove_prefix(std::min(each.size() + 1, rest.size()));
  }
  return false;
}

std::vector<std::string_view> OptionRow::choices() const {
  const auto is_placeholder = [](char c) { return is_upper(c) || c == ':' || c == '['; };
  if (std::ranges::any_of(value, is_placeholder)) return {};
  return split_words(value, "|");
}

std::vector<const OptionRow*> option_rows(Trait traits) {
  std::vector<const OptionRow*> rows;
  for (const OptionTopic& topic : option_topics())
    for (const OptionRow& row : topic.rows)
      if (row.is(traits)) rows.push_back(&row);
  return rows;
}

const OptionRow* find_option(Trait commands, std::string_view name) {
  for (const OptionTopic& topic : option_topics())
    for (const OptionRow& row : topic.rows)
      if (row.is(commands) && row.has_name(name)) return &row;
  return nullptr;
}

std::string with_options(std::string_view text) {
  std::string result;
  std::size_t done = 0;
  while (true) {
    const std::size_t open = text.find('`', done);
    const std::size_t close = open == std::string_view::npos ? open : text.find('`', open + 1);
    if (close == std::string_view::npos) break;
    const std::string_view name = text.substr(open + 1, close - open - 1);
    if (!may_precede(text.substr(0, open)) || !may_follow(text.substr(close + 1)) || !is_setting(name)) {
      // The second backquote may be the opening backquote of the next name.
      result += text.substr(done, close - done);
      done = close;
      continue;
    }
    result += text.substr(done, open - done);
    result += "--";
    std::ranges::replace_copy(name, std::back_inserter(result), '_', '-');
    done = close + 1;
  }
  return result += text.substr(done);
}

std::vector<std::string> with_options(const std::vector<std::string>& notes) {
  std::vector<std::string> worded;
  worded.reserve(notes.size());
  for (const std::string& note : notes) worded.push_back(with_options(note));
  return worded;
}

const OptionRow& OptionWords::row(std::string_view name) const {
  const OptionRow* found = find_option(command_, name);
  if (found == nullptr)
    found = find_option(any_command, name);  // options of other commands were not given, so they
                                             // have no words
  if (found == nullptr || found->key() != name)
    throw std::logic_error(fmt::format("'{}' is not the key of an option", name));
  return *found;
}

bool OptionWords::given_one_of(std::initializer_list<std::string_view> names) const {
  return std::ranges::any_of(names, [this](std::string_view name) { return given(name); });
}

const std::vector<std::string>& OptionWords::words(std::string_view name) const {
  static const std::vector<std::string> none;
  const auto found = words_.find(row(name).key());
  return found == words_.end() ? none : found->second;
}

const std::string& OptionWords::word(std::string_view name) const {
  static const std::string none;
  const std::vector<std::string>& all = words(name);
  return all.empty() ? none : all.back();
}

void OptionWords::set(std::string_view name, std::vector<std::string> values) {
  // An empty word means that there is no value, except for options with a list of texts.
  if (!row(name).is(Trait::list) && values.size() == 1 && values.front().empty()) values.clear();
  if (values.empty())
    words_.erase(std::string(name));
  else
    words_.insert_or_assign(std::string(name), std::move(values));
}

void OptionWords::set_default(std::string_view name, std::string value) {
  if (!given(name)) set(name, std::move(value));
}

void OptionWords::set_defaults(const State& state) {
  for (const auto& [name, values] : state.words())
    if (!given(name)) set(name, values);
}

State OptionWords::state() const {
  State state;
  for (const auto& [name, values] : words_)
    if (name != "config") state.set(name, values);
  return state;
}

std::optional<double> OptionWords::number(std::string_view name) const { return parsed(*this, name, parse_number); }

std::optional<double> OptionWords::positive(std::string_view name) const {
  return parsed(*this, name, api::parse_positive);
}

std::optional<int> OptionWords::count(std::string_view name, int low, int high) const {
  return parsed(*this, name, [&](const std::string& setting, const std::string& word) {
    return api::parse_count(setting, word, low, high);
  });
}

std::optional<std::uint64_t> OptionWords::bytes(std::string_view name) const {
  return parsed(*this, name, api::parse_bytes);
}

std::optional<ImageSize> OptionWords::size(std::string_view name) const { return parsed(*this, name, api::parse_size); }

std::optional<glm::dvec3> OptionWords::color(std::string_view name) const {
  return parsed(*this, name, api::parse_color);
}

std::optional<glm::dvec3> OptionWords::vector(std::string_view name, bool positive) const {
  return parsed(*this, name, [&](const std::string& setting, const std::string& word) {
    return api::parse_vector(setting, word, positive);
  });
}

std::optional<std::array<double, 2>> OptionWords::interval(std::string_view name, bool may_be_equal) const {
  return parsed(*this, name, [&](const std::string& setting, const std::string& word) {
    const auto ends = api::parse_numbers(setting, word, 2, fmt::format("two numbers; write {}", row(name).value));
    if (!(ends[0] < ends[1]) && !(may_be_equal && ends[0] == ends[1]))
      throw bad_input(fmt::format("{}: the numbers of '{}' are not in ascending order; write the smaller number first",
                                  setting, word));
    return std::array{ends[0], ends[1]};
  });
}

std::optional<std::size_t> OptionWords::choice(std::string_view name) const {
  return parsed(*this, name, [&](const std::string& setting, const std::string& word) {
    return api::parse_choice(setting, word, row(name).choices());
  });
}

}  // namespace v0_1
}  // namespace tessera
