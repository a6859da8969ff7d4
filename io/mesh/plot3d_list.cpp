// SPDX-License-Identifier: BSD-3-Clause
#include "io/mesh/plot3d_list.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "io/text/json_text.hpp"

namespace tessera::io {

std::vector<Plot3dStep> parse_plot3d_list(std::string_view text, const std::filesystem::path& input) {
  const std::string source = input.string();
  const nlohmann::json json = parse_json(text, source);
  const auto files = json.is_object() ? json.find("filenames") : json.end();
  if (!json.is_object() || files == json.end() || !files->is_array() || files->empty())
    throw scene::bad_input(
        fmt::format("{}: it has no list \"filenames\" of PLOT3D files; check that it is ParaView's", source));
  std::vector<Plot3dStep> steps;
  for (const nlohmann::json& entry : *files) {
    const auto fail = [&](const char* what) {
      return scene::bad_input(
          fmt::format("{}: entry {} of \"filenames\" {}; write the file again", source, steps.size(), what));
    };
    if (!entry.is_object()) throw fail("is not an object");
    const auto file_of = [&](const char* key) -> std::filesystem::path {
      const auto name = entry.find(key);
      if (name == entry.end()) return {};
      if (!name->is_string() || name->get<std::string>().empty()) throw fail("has an invalid name");
      return input.parent_path() / name->get<std::string>();
    };
    Plot3dStep step{static_cast<double>(steps.size()), file_of("xyz"), file_of("q"), !file_of("function").empty()};
    if (step.grid.empty()) throw fail("has no \"xyz\"");
    if (const auto time = entry.find("time"); time != entry.end()) {
      if (!time->is_number()) throw fail("has a \"time\" that is not a number");
      step.time = time->get<double>();
    }
    steps.push_back(std::move(step));
  }
  std::ranges::stable_sort(steps, {}, &Plot3dStep::time);
  return steps;
}

}  // namespace tessera::io
