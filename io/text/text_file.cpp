// SPDX-License-Identifier: BSD-3-Clause
#include "io/text/text_file.hpp"

#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cmath>
#include <fstream>

#include "io/text/scanner.hpp"
#include "scene/error.hpp"
#include "system/files_read.hpp"
#include "system/missing_file.hpp"
#include "tessera/program/text.hpp"

namespace tessera::io {
namespace {

constexpr std::uintmax_t largest_file = 64u << 20;

/// Whether the file is a device or a socket, which may keep a reader waiting forever. Standard input may be a terminal.
bool may_never_end(const std::filesystem::path& file) {
  struct stat facts {
  }, input{};
  if (::stat(file.c_str(), &facts) != 0 || S_ISREG(facts.st_mode) || S_ISFIFO(facts.st_mode)) return false;
  return ::fstat(STDIN_FILENO, &input) != 0 || input.st_dev != facts.st_dev || input.st_ino != facts.st_ino;
}

}  // namespace

std::string read_text_file(const std::filesystem::path& file) {
  std::error_code error;
  const auto status = std::filesystem::status(file, error);
  if (!std::filesystem::exists(status)) throw system::missing_file(file);
  if (std::filesystem::is_directory(status))
    throw scene::bad_input(file.string() + ": is a directory; name a file in it");
  if (may_never_end(file))
    throw scene::bad_input(file.string() + ": is neither a regular file nor a pipe; give one of the two");
  std::ifstream stream(file, std::ios::binary);
  if (!stream) throw scene::bad_input(file.string() + ": cannot be opened; check its permissions");
  system::note_read(file);
  // Reads in pieces, without asking for the size: a pipe has no size.
  std::string text;
  std::vector<char> piece(1u << 16);
  while (stream) {
    stream.read(piece.data(), static_cast<std::streamsize>(piece.size()));
    text.append(piece.data(), static_cast<std::size_t>(stream.gcount()));
    if (text.size() > largest_file)
      throw scene::bad_input(fmt::format(
          "{}: it is larger than {} MiB, too large for a text file of this kind; check that it is the right file",
          file.string(), largest_file >> 20));
  }
  // Some system files without a size refuse to be read; for any other file, a failed read is an I/O error.
  if (stream.bad() && std::filesystem::file_size(file, error) == 0)
    throw scene::bad_input(file.string() + ": it cannot be read as text; check that it is the right file");
  if (stream.bad())
    throw scene::Error(scene::ErrorCode::system_failure, file.string() + ": reading failed; check the disk");
  return text;
}

char first_character(std::string_view text) {
  if (text.starts_with(byte_order_mark)) text.remove_prefix(byte_order_mark.size());
  text = trimmed(text);
  return text.empty() ? '\0' : text.front();
}

std::optional<double> parse_number(std::string_view word) {
  const auto number = number_of<double>(word);
  return number && std::isfinite(*number) ? number : std::nullopt;
}

}  // namespace tessera::io
