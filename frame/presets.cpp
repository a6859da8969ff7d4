#include "tessera/presets.hpp"

#include "colormaps/presets.hpp"

namespace tessera {

TransferFunction preset_function(std::string_view name) { return colormaps::preset(name, {}).function; }

std::vector<std::string> preset_opacity_names() { return colormaps::preset_opacity_names(); }

}  // namespace tessera
