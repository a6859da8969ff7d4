// SPDX-License-Identifier: BSD-3-Clause
#include "io/scene/transfer_function_file.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "colormaps/function_options.hpp"
#include "colormaps/presets.hpp"
#include "io/scene/json_transfer_function.hpp"
#include "io/text/json_text.hpp"
#include "io/text/text_file.hpp"
#include "scene/error.hpp"
#include "system/missing_file.hpp"
#include "tessera/program/nearest_name.hpp"

namespace tessera::io {

namespace {

colormaps::LoadedTransferFunction load_file(const std::string& file,
                                            const colormaps::TransferFunctionOptions& options) {
  const std::string text = read_text_file(file);
  switch (first_character(text)) {
    case '[':
    case '{':
      return parse_json_transfer_function(text, file, options);
    case '<':
      throw scene::Error(scene::ErrorCode::bad_input, file, "is XML, which is not read as a transfer function",
                         "import it in ParaView and export it as .json");
    default:
      return parse_text_transfer_function(text, file, options);
  }
}

/// Returns the error for a name that is neither a file nor a preset; the error suggests what was probably meant.
scene::Error neither(const std::string& name) {
  const std::vector<std::string> presets = colormaps::preset_names();
  const std::size_t colon = std::min(name.find(':'), name.size());
  const auto near = nearest_name(std::string_view(name).substr(0, colon), presets);
  const std::string meant =
      near ? fmt::format("did you mean {}?", *near + name.substr(colon)) : system::meant_file(name);
  return {scene::ErrorCode::bad_input, name, "no such file and no preset",
          fmt::format("{}{}the presets are {}", meant, meant.empty() ? "" : " ", fmt::join(presets, ", "))};
}

}  // namespace

colormaps::LoadedTransferFunction load_transfer_function(const std::string& file_or_preset,
                                                         const colormaps::TransferFunctionOptions& options) {
  if (is_json_text(file_or_preset)) {
    const std::string source = "`transfer_function`";
    colormaps::LoadedTransferFunction loaded = parse_json_transfer_function(file_or_preset, source, options);
    loaded.name.replace(0, source.size(), "JSON");  // a JSON text does not have a file name
    return loaded;
  }
  if (colormaps::is_preset(file_or_preset)) return colormaps::preset(file_or_preset, options);
  if (!std::filesystem::exists(file_or_preset)) throw neither(file_or_preset);
  try {
    return load_file(file_or_preset, options);
  } catch (const scene::Error& error) {
    throw scene::with_subject(error, file_or_preset);
  }
}

}  // namespace tessera::io
