#include "io/transfer_function_file.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>
#include <filesystem>

#include "io/paraview_color_map.hpp"
#include "io/presets.hpp"
#include "io/text_file.hpp"
#include "io/transfer_function_checks.hpp"
#include "scene/error.hpp"

namespace tessera::io {

void check(const TransferFunctionOptions& options) {
  const auto [low, high] = options.field_range;
  if (!std::isfinite(low) || !std::isfinite(high) || low > high)
    throw scene::bad_input(fmt::format("field range {} to {}: low must be finite and not above high", low, high));
  const auto check_distance = [](double distance, const char* name) {
    if (!(distance > 0) || !std::isfinite(distance))
      throw scene::bad_input(fmt::format("{} is {}; it must be a positive length", name, distance));
  };
  if (options.unit_distance) check_distance(*options.unit_distance, "--unit-distance");
  check_distance(options.default_unit_distance, "default unit distance");
  if (!(options.opacity_scale >= 0) || !std::isfinite(options.opacity_scale))
    throw scene::bad_input(fmt::format("opacity scale is {}; it must not be negative", options.opacity_scale));
}

scene::TransferFunction make_transfer_function(std::vector<scene::Knot> knots, const std::string& source) {
  try {
    return scene::TransferFunction(std::move(knots));
  } catch (const scene::Error& error) {
    throw scene::Error(error.code(), source + ": " + error.what());
  }
}

LoadedTransferFunction load_transfer_function(const std::string& file_or_preset,
                                              const TransferFunctionOptions& options) {
  if (is_preset(file_or_preset)) return preset(file_or_preset, options);
  if (!std::filesystem::exists(file_or_preset))
    throw scene::bad_input(fmt::format("{}: no such file and no preset; the presets are {}", file_or_preset,
                                       fmt::join(preset_names(), ", ")));
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
