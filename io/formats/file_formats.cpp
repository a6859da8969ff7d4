// SPDX-License-Identifier: BSD-3-Clause
#include "tessera/file_formats.hpp"

#include <algorithm>

#include "io/files/reader_programs.hpp"
#include "io/formats/identify.hpp"

namespace tessera {
inline namespace v0_1 {

std::vector<FileFormat> file_formats() {
  std::vector<FileFormat> formats;
  for (const io::Format& row : io::formats()) {
    if (!row.is_listed) continue;
    const auto missing = std::ranges::find_if(row.needs, [](io::Reader reader) { return !io::has_reader(reader); });
    FileFormat format{row.name,
                      {},
                      row.holds,
                      row.remark,
                      row.recognizes != nullptr,
                      missing == row.needs.end() ? "" : io::reader_program(*missing).program};
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
