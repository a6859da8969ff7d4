// SPDX-License-Identifier: BSD-3-Clause
#include "io/mesh/nastran_deck.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <set>
#include <utility>

#include "io/files/inflated_file.hpp"
#include "io/files/whole_file.hpp"
#include "scene/error.hpp"
#include "tessera/program/text.hpp"

namespace tessera::io {
namespace {

constexpr std::size_t small_field = 8, large_field = 16, fields_a_line = 8;

/// Returns the fields of a line. The first is the name or a continuation mark.
std::vector<std::string> deck_fields(std::string_view line) {
  std::vector<std::string> fields;
  if (line.find(',') != std::string_view::npos) {
    while (true) {
      const std::size_t comma = line.find(',');
      fields.emplace_back(trimmed(line.substr(0, comma)));
      if (comma == std::string_view::npos) break;
      line.remove_prefix(comma + 1);
    }
  } else {
    std::string columns;  // a tab advances to the next field
    for (const char c : line)
      if (c == '\t')
        columns.append(small_field - columns.size() % small_field, ' ');
      else
        columns += c;
    const std::string_view all = columns;
    fields.emplace_back(trimmed(all.substr(0, small_field)));
    const std::size_t width = fields[0].find('*') != std::string::npos ? large_field : small_field;
    for (std::size_t at = small_field; at < all.size(); at += width)
      fields.emplace_back(trimmed(all.substr(at, width)));
  }
  const std::size_t most = fields[0].find('*') != std::string::npos ? fields_a_line / 2 : fields_a_line;
  // The last field of a line is a continuation mark. Some writers continue the line after the mark.
  if (const std::size_t mark = most + 1; fields.size() > mark + 1) {
    if (fields[mark].empty() || fields[mark][0] == '+' || fields[mark][0] == '*')
      fields.erase(fields.begin() + static_cast<std::ptrdiff_t>(mark));
    return fields;
  }
  fields.resize(most + 1);
  return fields;
}

/// "3" or "(3)".
std::string_view without_brackets(std::string_view text) {
  return text.starts_with('(') && text.ends_with(')') ? text.substr(1, text.size() - 2) : text;
}

}  // namespace

std::optional<std::int64_t> NastranEntry::whole_number(std::size_t field) const {
  if (is_blank(field)) return std::nullopt;
  const auto number = number_of<std::int64_t>(fields_[field]);
  if (!number) refuse(fmt::format("{} of {} is not a whole number; correct it", quote(fields_[field]), name_));
  return number;
}

double NastranEntry::real(std::size_t field) const {
  if (is_blank(field)) return 0;
  std::string text;
  for (const char c : fields_[field]) {
    const bool is_sign = c == '+' || c == '-';
    if (is_sign && !text.empty() && text.back() != 'e') text += 'e';  // "1.5-3"
    if (c == '+') continue;
    text += c == 'd' || c == 'D' || c == 'E' ? 'e' : c;
  }
  const auto number = number_of<double>(text);
  if (!number) refuse(fmt::format("{} of {} is not a number; correct it", quote(fields_[field]), name_));
  return *number;
}

void NastranEntry::refuse(const std::string& what) const {
  throw scene::bad_input(fmt::format("{}: line {}: {}", source_, line_, what));
}

bool NastranEntry::has_replications() const {
  return std::ranges::any_of(fields_, [](const std::string& f) { return f.starts_with('=') || f.starts_with('*'); });
}

void NastranEntry::replicate(const NastranEntry& before) {
  const auto copy = [&](std::size_t k) { return before.is_blank(k) ? "" : before.fields_[k]; };
  for (std::size_t k = 0; k < fields_.size(); ++k) {
    const std::string written = fields_[k];
    if (!written.starts_with('=') && !written.starts_with('*')) continue;
    if (before.name_ != name_)
      refuse(fmt::format("{} of {} has no {} before it that it could repeat; write a number", quote(written), name_,
                         name_));
    if (written == "=") {
      fields_[k] = copy(k);
    } else if (written == "==") {  // repeats fields to the end of the line; in the last line, of the entry
      std::size_t end = (k / fields_a_line + 1) * fields_a_line;
      if (end >= fields_.size()) fields_.resize(end = std::max(end, before.fields_.size()));
      for (; k < end; ++k) fields_[k] = copy(k);
    } else {
      fields_[k] = without_brackets(std::string_view(written).substr(1));
      if (written[0] == '=' || fields_[k].empty())
        refuse(fmt::format("{} of {} is not a valid replication; correct it", quote(written), name_));
      const auto number = number_of<std::int64_t>(before.is_blank(k) ? "0" : before.fields_[k]);
      const auto more = number_of<std::int64_t>(fields_[k]);
      std::int64_t sum = 0;
      if (number && more && __builtin_add_overflow(*number, *more, &sum))
        refuse(fmt::format("{} of {} leads to a number beyond 2^63; correct it", quote(written), name_));
      fields_[k] = number && more ? fmt::format("{}", sum) : fmt::format("{}", before.real(k) + real(k));
    }
  }
}

/// Joins lines into entries.
class NastranDeck {
 public:
  NastranDeck(const std::function<bool(std::string_view)>& is_used, const std::function<void(const NastranEntry&)>& use)
      : is_used_(is_used), use_(use) {}

  void read(const std::filesystem::path& file) {
    constexpr std::size_t most_deep = 64;
    std::error_code has_no_path;  // set for example for the content of a gzip file
    const std::filesystem::path path = std::filesystem::canonical(file, has_no_path);
    if (!seen_.insert(has_no_path ? file.string() : path.string()).second) return;
    if (++depth_ > most_deep)
      throw scene::bad_input(
          fmt::format("{}: more than {} files include one another; write them as one file", file.string(), most_deep));
    const WholeFile mapped(file);
    std::string_view text = mapped.text();
    if (text.substr(0, 4096).find('\0') != std::string_view::npos)
      throw scene::bad_input(fmt::format("{}: it is not text; give a Nastran bulk data file", file.string()));
    if (depth_ == 1 && !has_bulk_mark(text)) is_bulk_ = true;
    std::size_t number = 0;
    while (!text.empty() && !has_ended_) {
      std::string line = next_line(text, number);
      const std::size_t first = number;
      if (is_include(line)) {
        while (!has_both_quotes(line) && !text.empty()) line += trimmed(next_line(text, number));
        include(line, file, first);
      } else {
        add(line, file, number);
      }
    }
    --depth_;
  }

  void end_entry() {
    if (entry_.name_.empty()) return;
    if (is_image_ && std::ranges::all_of(entry_.fields_, &std::string::empty)) entry_.fields_ = pattern_;
    if (entry_.has_replications()) {
      pattern_ = entry_.fields_;
      for (; images_ > 0; --images_) {
        entry_.fields_ = pattern_;
        entry_.replicate(before_);
        use_(entry_);
        before_ = entry_;
      }
    } else {
      use_(entry_);
      std::swap(before_, entry_);
    }
    entry_.name_.clear();
  }

 private:
  /// Returns the next line without its comment.
  static std::string next_line(std::string_view& text, std::size_t& number) {
    const std::size_t end = text.find('\n');
    const std::string_view line = text.substr(0, end);
    text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
    ++number;
    return std::string(line.substr(0, line.find('$')));
  }

  static bool has_words(std::string_view line, std::string_view first, std::string_view second) {
    line = trimmed(line);
    if (!equals_ignoring_case(line.substr(0, first.size()), first)) return false;
    line = line.substr(first.size());
    if (second.empty()) return line.empty() || line[0] == ' ' || line[0] == '\'' || line[0] == '"' || line[0] == '\t';
    return equals_ignoring_case(trimmed(line).substr(0, second.size()), second);
  }
  /// Accepts BEGIN SUPER=1 and BEGIN BULK SUPER=1.
  static bool begins_part(std::string_view line, std::string_view part) {
    if (!has_words(line, "BEGIN", "")) return false;
    line = trimmed(trimmed(line).substr(5));
    if (has_words(line, "BULK", "")) line = trimmed(line.substr(4));
    return equals_ignoring_case(line.substr(0, part.size()), part);
  }
  static bool is_include(std::string_view line) { return has_words(line, "INCLUDE", ""); }

  static bool has_bulk_mark(std::string_view text) {
    for (std::size_t number = 0; !text.empty();)
      if (has_words(next_line(text, number), "BEGIN", "BULK")) return true;
    return false;
  }

  /// A file name without quotes ends with the line.
  static bool has_both_quotes(std::string_view line) {
    const std::size_t quote = line.find_first_of("'\"");
    return quote == std::string_view::npos || line.find(line[quote], quote + 1) != std::string_view::npos;
  }

  void include(std::string_view line, const std::filesystem::path& from, std::size_t number) {
    std::string_view name = trimmed(trimmed(line).substr(7));
    if (const std::size_t quote = name.find_first_of("'\""); quote != std::string_view::npos) {
      const char mark = name[quote];
      name = name.substr(quote + 1);
      name = name.substr(0, name.find(mark));
    }
    require_uncompressed(from);
    std::error_code unknown;
    const std::filesystem::path file = from.parent_path() / std::filesystem::path(name);
    const bool is_there = !name.empty() && std::filesystem::is_regular_file(file, unknown);
    if (!is_there && !is_bulk_) return;  // there is no mesh in the executive or case control section
    if (!is_there)
      throw scene::bad_input(fmt::format("{}: line {}: it includes {}, and there is no such file; put it there",
                                         from.string(), number, quote(name)));
    end_entry();
    read(file);
  }

  void add(const std::string& line, const std::filesystem::path& file, std::size_t number) {
    if (trimmed(line).empty()) return;
    for (const char* part : {"SUPER", "AUXMODEL", "MODULE"})
      if (begins_part(line, part))
        throw scene::bad_input(
            fmt::format("{}: line {}: BEGIN {} begins a part with its own numbering, which is not supported; give each "
                        "part as a file of its own",
                        file.string(), number, part));
    if (has_words(line, "BEGIN", "BULK")) {
      is_bulk_ = true;
      return;
    }
    if (!is_bulk_) return;
    const char first = line[0];
    const bool continues = first == '+' || first == '*' || first == ' ' || first == ',' || first == '\t';
    if (continues && entry_.name_.empty()) return;  // continues an entry that is not used
    std::vector<std::string> fields;
    if (!continues) {
      end_entry();
      std::string name = upper_case(trimmed(std::string_view(line).substr(0, line.find_first_of(", \t*\r"))));
      is_image_ = name.starts_with('=');
      if (is_image_ && before_.name_.empty()) return;  // replicates an entry that is not used
      const std::string images = is_image_ ? std::exchange(name, before_.name_).substr(1) : "";
      name.resize(std::min(name.size(), small_field));
      has_ended_ = name == "ENDDATA";
      if (has_ended_ || !is_used_(name)) return before_.name_.clear();
      entry_.name_ = std::move(name);
      entry_.source_ = file.string();
      entry_.line_ = number;
      entry_.fields_.clear();
      count_images(images);
    }
    fields = deck_fields(line);
    entry_.fields_.insert(entry_.fields_.end(), std::make_move_iterator(fields.begin() + 1),
                          std::make_move_iterator(fields.end()));
  }

  /// Parses "(3)", "3" or "": the number of replications.
  void count_images(const std::string& images) {
    constexpr std::size_t most_images = 10'000'000;
    const auto count = number_of<std::size_t>(images.empty() ? "1" : without_brackets(images));
    if (!count) entry_.refuse(fmt::format("{} is not a number of replications; correct it", quote("=" + images)));
    images_ = *count;
    if (is_image_ && images_ > most_images - all_images_)
      entry_.refuse(fmt::format("it replicates more than {} entries; write them out", most_images));
    if (is_image_) all_images_ += images_;
  }

  const std::function<bool(std::string_view)>& is_used_;
  const std::function<void(const NastranEntry&)>& use_;
  NastranEntry entry_, before_;
  std::vector<std::string> pattern_;  ///< the last replication as written
  std::size_t images_ = 1, all_images_ = 0;
  bool is_image_ = false;  ///< entry_ begins with '='
  std::set<std::string> seen_;
  std::size_t depth_ = 0;
  bool is_bulk_ = false, has_ended_ = false;
};

void read_nastran_deck(const std::filesystem::path& file, const std::function<bool(std::string_view)>& is_used,
                       const std::function<void(const NastranEntry&)>& use) {
  NastranDeck deck(is_used, use);
  deck.read(file);
  deck.end_entry();
}

}  // namespace tessera::io
