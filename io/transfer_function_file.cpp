#include "io/transfer_function_file.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>
#include <filesystem>

#include "colormaps/function_options.hpp"
#include "colormaps/presets.hpp"
#include "io/paraview_color_map.hpp"
#include "io/text_file.hpp"
#include "scene/error.hpp"

namespace tessera::io {

namespace {

colormaps::LoadedTransferFunction load_file(const std::string& file,
                                            const colormaps::TransferFunctionOptions& options) {
  const std::string text = read_text_file(file);
  switch (first_character(text)) {
    case '[':
    case '{':
      return parse_paraview_color_map(text, file, options);
    case '<':
      throw scene::Error(scene::ErrorCode::bad_input, file, "is XML, which is not read as a transfer function",
                         "import it in ParaView and export it as .json");
    default:
      return parse_text_transfer_function(text, file, options);
  }
}

}  // namespace

colormaps::LoadedTransferFunction load_transfer_function(const std::string& file_or_preset,
                                                         const colormaps::TransferFunctionOptions& options) {
  if (colormaps::is_preset(file_or_preset)) return colormaps::preset(file_or_preset, options);
  if (!std::filesystem::exists(file_or_preset))
    throw scene::Error(scene::ErrorCode::bad_input, file_or_preset, "no such file and no preset",
                       fmt::format("the presets are {}", fmt::join(colormaps::preset_names(), ", ")));
  try {
    return load_file(file_or_preset, options);
  } catch (const scene::Error& error) {
    throw scene::with_subject(error, file_or_preset);
  }
}

}  // namespace tessera::io
