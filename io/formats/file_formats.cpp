// SPDX-License-Identifier: BSD-3-Clause
#include "tessera/file_formats.hpp"

#include <algorithm>

#include "io/formats/file_kinds.hpp"
#include "io/formats/reader_programs.hpp"

namespace tessera::io {
namespace {

/// The first of a format's readers that is not installed; empty if all are.
const char* left_out(Needs needs) {
  for (const ReaderProgram& program : reader_programs())
    if (needs_reader(needs, program.reader) && !has_reader(program.reader)) return program.program;
  return "";
}

}  // namespace

}  // namespace tessera::io

namespace tessera {
inline namespace v0_1 {

std::vector<FileFormat> file_formats() {
  std::vector<FileFormat> formats;
  for (const io::FormatRow& row : io::format_rows()) {
    if (row.listed == io::FormatRow::Listed::no) continue;
    FileFormat format{row.name, {}, row.holds, row.remark, row.begins != nullptr, io::left_out(row.needs)};
    std::string_view rest = row.extensions;
    while (!rest.empty()) {
      const std::size_t end = std::min(rest.find(' '), rest.size());
      format.extensions.emplace_back(rest.substr(0, end));
      rest.remove_prefix(std::min(end + 1, rest.size()));
    }
    formats.push_back(std::move(format));
  }
  return formats;
}

}  // namespace v0_1
}  // namespace tessera
