#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "io/foreign_numbers.hpp"
#include "io/stl_file.hpp"

namespace tessera::io {

Surface read_stl(const std::string& source) {
  const ForeignFile opened = open_foreign(std::make_shared<HelperProcess>(), source, {{"reader", "stl"}});
  if (opened.contents.parts.size() != 1) refuse_surface(source);
  const ForeignPart& part = opened.contents.parts.front();
  Surface surface;
  if (!part.points || !part.offsets || !part.connectivity) return surface;
  if (part.points->type != NumberType::float32 || part.points->components != 3 ||
      part.offsets->type != NumberType::int64 || part.connectivity->type != NumberType::uint32)
    refuse_surface(source);
  for (const auto numbers = numbers_of<glm::vec3>(opened, *part.points); const glm::vec3& p : numbers)
    surface.points.emplace_back(p);
  const auto offsets = numbers_of<std::int64_t>(opened, *part.offsets);
  const auto corners = numbers_of<std::uint32_t>(opened, *part.connectivity);
  for (std::size_t c = 0; c + 1 < offsets.size(); ++c) {
    if (offsets[c] < 0 || offsets[c + 1] < offsets[c] || static_cast<std::uint64_t>(offsets[c + 1]) > corners.size())
      refuse_surface(source);
    Polygon polygon;
    for (auto k = static_cast<std::size_t>(offsets[c]); k < static_cast<std::size_t>(offsets[c + 1]); ++k) {
      if (corners[k] >= surface.points.size())
        throw scene::bad_input(fmt::format("{}: face {} uses point {}, the file holds {}; write it anew", source, c,
                                           corners[k], surface.points.size()));
      polygon.push_back(corners[k]);
    }
    surface.facets.push_back({{std::move(polygon)}, {}});
  }
  return surface;
}

}  // namespace tessera::io
