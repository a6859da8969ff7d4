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

colormaps::LoadedTransferFunction load_transfer_function(const std::string& file_or_preset,
                                                         const colormaps::TransferFunctionOptions& options) {
  if (colormaps::is_preset(file_or_preset)) return colormaps::preset(file_or_preset, options);
  if (!std::filesystem::exists(file_or_preset))
    throw scene::bad_input(fmt::format("{}: no such file and no preset; the presets are {}", file_or_preset,
                                       fmt::join(colormaps::preset_names(), ", ")));
  const std::string text = read_text_file(file_or_preset);
  switch (first_character(text)) {
    case '[':
    case '{':
      return parse_paraview_color_map(text, file_or_preset, options);
    case '<':
      throw scene::bad_input(file_or_preset +
                             ": is XML, which is not read as a transfer function; import it in ParaView and export it "
                             "as .json");
    default:
      return parse_text_transfer_function(text, file_or_preset, options);
  }
}

}  // namespace tessera::io
