#pragma once

#include <string_view>

#include "tessera/export.hpp"
#include "tessera/transfer_function.hpp"

namespace tessera {

/// The transfer function of a name, COLOURS or COLOURS:OPACITY (preset_names()), over the values from 0 to 1, per unit
/// distance 1. Throws Error(bad_input) for an unknown name, with those known.
TESSERA_EXPORT TransferFunction preset_function(std::string_view name);

}  // namespace tessera
