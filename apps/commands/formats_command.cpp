// SPDX-License-Identifier: BSD-3-Clause
#include "apps/commands/formats_command.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "tessera/file_formats.hpp"
#include "tessera/program/options.hpp"

namespace tessera::apps {
namespace {

const char* word(FileHolds holds) {
  switch (holds) {
    case FileHolds::mesh:
      return "mesh";
    case FileHolds::surface:
      return "surface";
    case FileHolds::grid:
      return "volume";
    case FileHolds::grid_or_mesh:
      return "volume or mesh";
    case FileHolds::series:
      return "time series";
    case FileHolds::not_read:
      break;
  }
  return "not read";
}

void print_text(const std::vector<FileFormat>& all) {
  std::size_t name_width = 0, ending_width = 0;
  for (const FileFormat& format : all) {
    name_width = std::max(name_width, format.name.size());
    ending_width = std::max(ending_width, fmt::format("{}", fmt::join(format.extensions, " ")).size());
  }
  for (const FileFormat& format : all)
    fmt::print("{:<{}}  {:<{}}  {:<14}  {}{}{}\n", format.name, name_width,
               fmt::format("{}", fmt::join(format.extensions, " ")), ending_width, word(format.holds),
               format.left_out.empty() ? "" : fmt::format("needs {}, which is not installed", format.left_out),
               format.left_out.empty() || format.remark.empty() ? "" : "; ", with_options(format.remark));
  fmt::print(
      "\nThe first bytes of a file decide its format, then its name (PLOT3D, TetGen's files, .tets and .raw: only the "
      "name).\nFormats that consist of one file are also read from .gz.\n");
}

}  // namespace

void formats(bool as_json) {
  const std::vector<FileFormat> all = file_formats();
  if (!as_json) return print_text(all);
  auto list = nlohmann::ordered_json::array();
  for (const FileFormat& format : all)
    list.push_back({{"name", format.name},
                    {"extensions", format.extensions},
                    {"holds", word(format.holds)},
                    {"remark", with_options(format.remark)},
                    {"recognized_by_content", format.recognized_by_content},
                    {"left_out", format.left_out}});
  fmt::print("{}\n", list.dump(2));
}

}  // namespace tessera::apps
