// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>
#include <initializer_list>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "tessera/camera.hpp"
#include "tessera/state.hpp"

/// The options of the program `tessera`, each one row of one table (api/options/option_table.cpp). Command line, help,
/// manual pages, completion, files of options, states of `tessera serve` and the names in messages are loops over it.
namespace tessera {
inline namespace v0_1 {

/// What is true of an option: a set of bits.
enum class Trait : std::uint32_t {
  // The commands that have it.
  render = 1u << 0,
  serve = 1u << 1,
  info = 1u << 2,
  convert = 1u << 3,
  generate = 1u << 4,
  chart = 1u << 5,
  timing = 1u << 6,
  formats = 1u << 7,
  presets = 1u << 8,
  help = 1u << 9,
  completion = 1u << 10,
  // How it is written; without these `--name VALUE`, once.
  flag = 1u << 11,        ///< alone
  place = 1u << 12,       ///< alone, or `--name=VALUE`
  list = 1u << 13,        ///< may be repeated
  positional = 1u << 14,  ///< a word without a name before it; of a list the remaining ones
  required = 1u << 15,
  basic = 1u << 16,  ///< `--help` shows it; others are in `--help-all`
  // What it is for; without these for both.
  meshes = 1u << 17,
  volumes = 1u << 18,
  // What it is in a state of `tessera serve`, which is JSON; the server's other options only its command line sets.
  state = 1u << 19,     ///< a client may set it, as text, true or a list of texts
  camera = 1u << 20,    ///< and it is a camera as an object
  function = 1u << 21,  ///< and it is a transfer function as an object, or a preset's name
  surfaces = 1u << 22,  ///< and it names no file that the server was not started with
  // What it changes.
  data = 1u << 23,        ///< what is read
  look = 1u << 24,        ///< the transfer function
  knots = 1u << 25,       ///< and the knots of a function as JSON contain it
  range = 1u << 26,       ///< and it is about the range of values
  settings = 1u << 27,    ///< how is rendered
  view = 1u << 28,        ///< the view; a camera replaces it
  annotation = 1u << 29,  ///< what is drawn over the picture
  machine = 1u << 30,     ///< no picture, only what rendering takes
};
constexpr Trait operator|(Trait a, Trait b) {
  return static_cast<Trait>(static_cast<std::uint32_t>(a) | static_cast<std::uint32_t>(b));
}

struct OptionRow {
  std::string_view names;  ///< without dashes, commas between; perhaps first one letter, then the key
  std::string_view value;  ///< what stands for its value in help, like "WxH"; "a|b|c": it is one of these words
  Trait traits;
  std::string_view help;

  /// Whether it has one of these traits.
  [[nodiscard]] constexpr bool is(Trait trait) const {
    return (static_cast<std::uint32_t>(traits) & static_cast<std::uint32_t>(trait)) != 0;
  }
  /// The name that states, files of options and OptionWords have.
  [[nodiscard]] constexpr std::string_view key() const {
    const std::string_view longer = names.find(',') == 1 ? names.substr(2) : names;
    return longer.substr(0, longer.find(','));
  }
  [[nodiscard]] bool has_name(std::string_view name) const;
  /// The words between the bars of `value`; none if some stand for others, as capitals, colons and brackets do.
  [[nodiscard]] std::vector<std::string_view> choices() const;
};

/// Options under one title of the help, in the order of the help.
struct OptionTopic {
  std::string_view title;
  std::span<const OptionRow> rows;
};
std::span<const OptionTopic> option_topics();

/// All rows with one of these traits, in the order of the help.
std::vector<const OptionRow*> option_rows(Trait traits);

/// The option that commands have by this name; null: none.
const OptionRow* find_option(Trait commands, std::string_view name);

/// `text` with every setting that it names as an option: `tile_size`, in backquotes, becomes --tile-size. Libraries
/// know settings, the program has options: where a message says "raise `memory`", its user reads "raise --memory". Only
/// names of options, and only where they are words of their own, for file names may hold backquotes. (A file named
/// `memory`, backquotes and no directory, is taken for the setting.)
std::string with_options(std::string_view text);
std::vector<std::string> with_options(const std::vector<std::string>& notes);

/// The words that were given for the options of a command. Names are keys of its rows.
///
/// The functions that return values throw Error(bad_input) which names the option, what was given and what is allowed;
/// nothing was given: none.
class OptionWords {
 public:
  OptionWords() = default;  ///< of `render`
  explicit OptionWords(Trait command) : command_(command) {}
  explicit OptionWords(const State& state) : words_(state.words()) {}

  [[nodiscard]] bool given(std::string_view name) const { return !words(name).empty(); }
  [[nodiscard]] bool given_one_of(std::initializer_list<std::string_view> names) const;
  /// The last one; empty if none is given.
  [[nodiscard]] const std::string& word(std::string_view name) const;
  [[nodiscard]] const std::vector<std::string>& words(std::string_view name) const;
  /// Without values the option is no longer given. A flag's is "true".
  void set(std::string_view name, std::vector<std::string> values);
  void set(std::string_view name, std::string value) { set(name, std::vector{std::move(value)}); }
  /// As `set`, unless it is given.
  void set_default(std::string_view name, std::string value);
  void set_defaults(const State& state);
  /// All that are given, by key in alphabetical order.
  [[nodiscard]] const State::Words& all() const { return words_; }
  /// Of `render`, but for --config.
  [[nodiscard]] State state() const;

  [[nodiscard]] std::optional<double> number(std::string_view name) const;
  [[nodiscard]] std::optional<double> positive(std::string_view name) const;
  [[nodiscard]] std::optional<int> count(std::string_view name, int low,
                                         int high = std::numeric_limits<int>::max()) const;
  [[nodiscard]] std::optional<std::uint64_t> bytes(std::string_view name) const;
  [[nodiscard]] std::optional<ImageSize> size(std::string_view name) const;
  [[nodiscard]] std::optional<glm::dvec3> color(std::string_view name) const;
  [[nodiscard]] std::optional<glm::dvec3> vector(std::string_view name, bool positive = false) const;
  /// Two numbers, the second of them larger, or `may_be_equal`.
  [[nodiscard]] std::optional<std::array<double, 2>> interval(std::string_view name, bool may_be_equal = false) const;
  /// Which of its row's choices was given, as the same one of `values`.
  template <class T>
  [[nodiscard]] std::optional<T> choice(std::string_view name, std::initializer_list<T> values) const {
    const auto at = choice(name);
    return at ? std::optional<T>(values.begin()[*at]) : std::nullopt;
  }
  [[nodiscard]] std::optional<std::size_t> choice(std::string_view name) const;

 private:
  [[nodiscard]] const OptionRow& row(std::string_view name) const;

  Trait command_ = Trait::render;
  State::Words words_;
};

/// All of `text` as a finite number, whatever the locale. Throws Error(bad_input), its subject `option`.
double parse_number(const std::string& option, const std::string& text);

/// `value`, if there is one, to `target`.
template <class T, class U>
void assign(T& target, const std::optional<U>& value) {
  if (value) target = static_cast<T>(*value);
}

}  // namespace v0_1
}  // namespace tessera
