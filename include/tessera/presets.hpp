#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "tessera/export.hpp"
#include "tessera/transfer_function.hpp"

namespace tessera {

/// The transfer function of a name, COLOURS or COLOURS:OPACITY (preset_names()), over the values from 0 to 1, per unit
/// distance 1. Throws Error(bad_input) for an unknown name, with those known.
TESSERA_EXPORT TransferFunction preset_function(std::string_view name);

/// What OPACITY may be, the default first.
TESSERA_EXPORT std::vector<std::string> preset_opacity_names();

}  // namespace tessera
