#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace tessera::scene {

/// Of names that there are the one that a wrong name most likely means, for messages: the first of those with the
/// fewest letters added, left out, replaced or swapped with their neighbour, whatever their case; names that are paths
/// are compared by their last part too. Nothing if that takes more than a third of the letters. Looks at the first
/// 10,000 names.
std::optional<std::string> nearest_name(std::string_view wrong, std::span<const std::string> names);

}  // namespace tessera::scene
