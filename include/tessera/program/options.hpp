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

/// The options of the program `tessera`. Each option is a row of a table (api/options/option_table.cpp), from which
/// command line, help, manual pages, completion, files of options, states of `tessera serve` and the names in messages
/// are generated.
namespace tessera {
inline namespace v0_1 {

/// Properties of an option: a set of bits.
enum class Trait : std::uint32_t {
  // The commands that have the option.
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
  // How the option is written. Without any of these traits: `--name VALUE`, at most once.
  flag = 1u << 11,        ///< without a value
  place = 1u << 12,       ///< without a value, or `--name=VALUE`
  list = 1u << 13,        ///< may be repeated
  positional = 1u << 14,  ///< a word without the option's name; for a list, all remaining words
  required = 1u << 15,
  basic = 1u << 16,  ///< shown by `--help`; all other options are shown only by `--help-all`
  // The kind of data to which the option applies. Without any of these traits: both kinds.
  meshes = 1u << 17,
  volumes = 1u << 18,
  // The option's form in a state of `tessera serve`, which is JSON. Options of the server without any of these traits
  // can only be set on the command line.
  state = 1u << 19,     ///< a client may set the option, as text, true or a list of texts
  camera = 1u << 20,    ///< the value may also be an object with a camera
  function = 1u << 21,  ///< the value may also be an object with a transfer function, or a preset's name
  surfaces = 1u << 22,  ///< the value may also contain names of files, but only of those with which the server was
                        ///< started
  // What the option changes.
  data = 1u << 23,        ///< what is read
  look = 1u << 24,        ///< the transfer function
  knots = 1u << 25,       ///< the knots of the transfer function; knots given in JSON already include the change
  settings = 1u << 27,    ///< how the data are rendered
  view = 1u << 28,        ///< the view; a camera replaces it
  annotation = 1u << 29,  ///< what is drawn over the image
  machine = 1u << 30,     ///< only the resources for rendering, not the image
};
constexpr Trait operator|(Trait a, Trait b) {
  return static_cast<Trait>(static_cast<std::uint32_t>(a) | static_cast<std::uint32_t>(b));
}

struct OptionRow {
  std::string_view names;  ///< names without dashes, separated by commas: an optional letter, then the key
  std::string_view value;  ///< placeholder for the value in the help, like "WxH"; "a|b|c": the value is one of these
                           ///< words
  Trait traits;
  std::string_view help;

  /// Whether the option has at least one of these traits.
  [[nodiscard]] constexpr bool is(Trait trait) const {
    return (static_cast<std::uint32_t>(traits) & static_cast<std::uint32_t>(trait)) != 0;
  }
  /// The option's name in states, files of options and OptionWords.
  [[nodiscard]] constexpr std::string_view key() const {
    const std::string_view longer = names.find(',') == 1 ? names.substr(2) : names;
    return longer.substr(0, longer.find(','));
  }
  [[nodiscard]] bool has_name(std::string_view name) const;
  /// The words between the bars of `value`. Empty if some of them are placeholders, which contain capitals, colons or
  /// brackets.
  [[nodiscard]] std::vector<std::string_view> choices() const;
};

/// Options under one title of the help, in the order of the help.
struct OptionTopic {
  std::string_view title;
  std::span<const OptionRow> rows;
};
std::span<const OptionTopic> option_topics();

/// All rows with at least one of these traits, in the order of the help.
std::vector<const OptionRow*> option_rows(Trait traits);

/// Returns the option of this name of one of the `commands`; null if there is none.
const OptionRow* find_option(Trait commands, std::string_view name);

/// Returns `text` with the name of every setting replaced by its option: `tile_size`, in backquotes, becomes
/// --tile-size. The messages of libraries contain names of settings, but users of the program know its options: "raise
/// `memory`" becomes "raise --memory". Only names of options that are whole words are replaced, because file names may
/// contain backquotes. (The name of a file `memory`, with backquotes and without a directory, is replaced by mistake.)
std::string with_options(std::string_view text);
std::vector<std::string> with_options(const std::vector<std::string>& notes);

/// The words given for the options of a command. The `name` of an option is the key of its row.
///
/// The functions that return values throw Error(bad_input), which names the option, its value and the allowed values.
/// They return none if the option is not given.
class OptionWords {
 public:
  OptionWords() = default;  ///< the words of the command `render`
  explicit OptionWords(Trait command) : command_(command) {}
  explicit OptionWords(const State& state) : words_(state.words()) {}

  [[nodiscard]] bool given(std::string_view name) const { return !words(name).empty(); }
  [[nodiscard]] bool given_one_of(std::initializer_list<std::string_view> names) const;
  /// The last word given for the option; empty if none is given.
  [[nodiscard]] const std::string& word(std::string_view name) const;
  [[nodiscard]] const std::vector<std::string>& words(std::string_view name) const;
  /// Sets the values of an option. Without values, the option is removed. The value of a flag is "true".
  void set(std::string_view name, std::vector<std::string> values);
  void set(std::string_view name, std::string value) { set(name, std::vector{std::move(value)}); }
  /// Sets the value of an option unless the option is already given.
  void set_default(std::string_view name, std::string value);
  void set_defaults(const State& state);
  /// All given options, in the alphabetical order of their keys.
  [[nodiscard]] const State::Words& all() const { return words_; }
  /// The state that the words describe, for `render`; does not contain --config.
  [[nodiscard]] State state() const;

  [[nodiscard]] std::optional<double> number(std::string_view name) const;
  [[nodiscard]] std::optional<double> positive(std::string_view name) const;
  [[nodiscard]] std::optional<int> count(std::string_view name, int low,
                                         int high = std::numeric_limits<int>::max()) const;
  [[nodiscard]] std::optional<std::uint64_t> bytes(std::string_view name) const;
  [[nodiscard]] std::optional<ImageSize> size(std::string_view name) const;
  [[nodiscard]] std::optional<glm::dvec3> color(std::string_view name) const;
  [[nodiscard]] std::optional<glm::dvec3> vector(std::string_view name, bool positive = false) const;
  /// Two numbers; the second is larger than the first or, if `may_be_equal`, at least as large.
  [[nodiscard]] std::optional<std::array<double, 2>> interval(std::string_view name, bool may_be_equal = false) const;
  /// Returns the element of `values` whose index is that of the given word in the choices of the option's row.
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

/// Converts the whole `text` to a finite number, independent of the locale. Throws Error(bad_input) with `option` as
/// its subject.
double parse_number(const std::string& option, const std::string& text);

/// Assigns `value`, if there is one, to `target`.
template <class T, class U>
void assign(T& target, const std::optional<U>& value) {
  if (value) target = static_cast<T>(*value);
}

}  // namespace v0_1
}  // namespace tessera
