#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "scene/transfer_function.hpp"

namespace tessera::io {

/// How a file's or a preset's numbers become extinction [1 / world unit] and linear colour.
struct TransferFunctionOptions {
  /// The field's smallest and largest value: presets span it, and files with `rescale`. low == high is a constant
  /// field.
  std::array<double, 2> field_range{0, 1};
  /// `--unit-distance`: the length, in world units, over which a file's opacity holds. Wins over the file's own.
  std::optional<double> unit_distance{};
  /// Used where neither the file nor the user names one; the caller derives it from the mesh and prints it.
  /// Meant to be a tenth of the mesh's mean thickness: the ramps below then make an average ray the short way through
  /// it 0.26 to 0.89 opaque.
  double default_unit_distance = 1;
  /// `--blend display`: colours stay as the file shows them, undecoded from sRGB, as VTK composites them.
  bool display_colors = false;
  double opacity_scale = 1;  ///< multiplies extinction, >= 0
  /// `--rescale`: stretch a file's values over the field's range, as ParaView's "rescale to data range" does. Without
  /// it they are the field's own values, whatever they span.
  bool rescale = false;
};

struct LoadedTransferFunction {
  scene::TransferFunction function;
  std::string name;                       ///< the preset's or the file's, with what was assumed in brackets
  std::optional<double> unit_distance{};  ///< that was used; none where the file gives extinctions
  /// "file", "--unit-distance", "default", or "" where extinctions are absolute.
  std::string unit_distance_source;
};

/// Loads a preset (`NAME` or `NAME:VARIANT`, see presets.hpp) or a file: ParaView's colour-map JSON if it begins with
/// `[` or `{`, plain text otherwise. A preset's name wins; `./viridis` is the file. Throws Error(bad_input) in one line
/// naming file, line and remedy.
LoadedTransferFunction load_transfer_function(const std::string& file_or_preset,
                                              const TransferFunctionOptions& options);

/// What is used when nothing is asked for: cool-warm with a gentle ramp of opacity that is nowhere zero, so that any
/// field, a constant one too, gives a picture that is neither black nor saturated.
LoadedTransferFunction default_transfer_function(const TransferFunctionOptions& options);

/// All that load_transfer_function takes before a colon.
std::vector<std::string> preset_names();

/// Plain text, one knot a line: `value r g b extinction`, separated by blanks, values not decreasing. Colours are
/// linear and extinctions per world unit as they stand. `#` begins a comment; blank lines, CR LF and a UTF-8 byte order
/// mark are allowed. Commas are not, since some countries write decimals with them. Two lines of one value make a step.
LoadedTransferFunction parse_text_transfer_function(std::string_view text, const std::string& source,
                                                    const TransferFunctionOptions& options);

}  // namespace tessera::io
