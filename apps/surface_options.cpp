#include "apps/surface_options.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "apps/argument_values.hpp"
#include "tessera/error.hpp"

namespace tessera::apps {
namespace {

/// VALUE, VALUE:COLOUR, VALUE:COLOUR:OPACITY or VALUE::OPACITY.
IsoSurface iso_of(const std::string& word) {
  const std::size_t first = std::min(word.find(':'), word.size());
  const std::size_t second = std::min(word.find(':', first + 1), word.size());
  IsoSurface iso;
  iso.value = parse_number("--iso", word.substr(0, first));
  if (first + 1 < second) {
    const auto color = parse_color("--iso", word.substr(first + 1, second - first - 1));
    iso.color = glm::dvec3(color[0], color[1], color[2]);
  }
  if (second < word.size()) {
    iso.opacity = parse_number("--iso", word.substr(second + 1));
    if (!(iso.opacity > 0 && iso.opacity <= 1))
      throw bad_input(fmt::format("--iso {}: the opacity {} is not above 0 and at most 1", word, iso.opacity));
  }
  return iso;
}

}  // namespace

void add_surface_options(CLI::App& command, SurfaceWords& words) {
  command
      .add_option("--iso", words.iso,
                  "the surface where the field has this value, lit, within the volume (colour: the transfer function's "
                  "there; opacity 1); may be repeated")
      ->type_name("VALUE[:COLOUR[:OPACITY]]")
      ->allow_extra_args(false);
}

Surfaces surfaces_of(const SurfaceWords& words) {
  Surfaces surfaces;
  for (const std::string& word : words.iso) surfaces.iso.push_back(iso_of(word));
  return surfaces;
}

std::vector<std::string> unseen_surfaces(const Surfaces& surfaces, const std::array<double, 2>& range) {
  std::vector<std::string> warnings;
  for (const IsoSurface& iso : surfaces.iso)
    if (!(range[0] < iso.value && iso.value <= range[1]))
      warnings.push_back(
          fmt::format("--iso {}: shows nothing, the field goes from {:.6g} to {:.6g}; choose a value between",
                      iso.value, range[0], range[1]));
  return warnings;
}

}  // namespace tessera::apps
