// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "scene/quote.hpp"

namespace tessera::io {

/// The whole of a small file (transfer function, camera). Throws Error(bad_input) if it is missing, a folder, or larger
/// than 64 MiB, which no such file is; Error(system_failure) if reading fails.
std::string read_text_file(const std::filesystem::path& file);

/// One line that holds something, cut into its words; `number` counts from 1.
struct TextLine {
  std::size_t number = 0;
  std::vector<std::string_view> words;
};

/// Walks through a text line by line, leaving out blank lines and what follows a `#`. Knows LF and CR LF, and passes
/// over a UTF-8 byte order mark. The text must outlive the words.
class TextLines {
 public:
  explicit TextLines(std::string_view text);
  /// False at the end.
  bool next(TextLine& line);

 private:
  std::string_view rest_;
  std::size_t number_ = 0;
};

/// First character that is no blank, or 0 in an empty text; passes over a byte order mark.
char first_character(std::string_view text);

/// A finite double that fills the whole word, in the C locale whatever the user's is; a leading + is allowed.
std::optional<double> parse_number(std::string_view word);

using scene::quote;

}  // namespace tessera::io
