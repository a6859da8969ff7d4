// SPDX-License-Identifier: BSD-3-Clause
#include "io/foreign/client/foreign_fill.hpp"

#include <nlohmann/json.hpp>

#include "io/foreign/client/foreign_numbers.hpp"
#include "io/foreign/messages/surface_message.hpp"

namespace tessera::io {

FilledMesh fill_surface(const cells::Surface& surface, const FillSize& size, const InputFile& file) {
  const std::string source = file.path.string();
  HelperTask task{"filling it by TetGen", "correct the surface", Reader::tetgen};
  task.limit_remedy =
      size.is_chosen ? "correct the surface, or set a larger `max_volume`"
                     : "correct the surface, or set `max_volume`, which allows filling to take more time and memory";
  nlohmann::json request{{"reader", "fill"},  {"surface", json_of(surface)}, {"max_volume", size.max_volume},
                         {"tets", size.tets}, {"is_chosen", size.is_chosen}, {"limit_remedy", task.limit_remedy}};
  const ForeignFile opened = open_foreign(file, std::move(request), {}, std::move(task));
  if (opened.contents.parts.size() != 1) refuse_surface(source);
  const ForeignPart& part = opened.contents.parts.front();
  FilledMesh filled;
  if (!part.points || part.points->components != 3 || part.points->type != NumberType::float64 || !part.connectivity ||
      part.connectivity->type != NumberType::uint32 || part.connectivity->tuples % 4 != 0 ||
      part.point_fields.size() != 1 + surface.attributes.size())
    refuse_surface(source);
  filled.points = numbers_of<glm::dvec3>(opened, *part.points);
  filled.tets = numbers_of<std::uint32_t>(opened, *part.connectivity);
  for (const std::uint32_t v : filled.tets)
    if (v >= filled.points.size()) refuse_surface(source);
  for (const ForeignArray& field : part.point_fields)
    if (field.type != NumberType::float64 || field.tuples != filled.points.size()) refuse_surface(source);
  filled.depth = numbers_of<double>(opened, part.point_fields.front());
  for (std::size_t a = 1; a < part.point_fields.size(); ++a)
    filled.attributes.push_back(numbers_of<double>(opened, part.point_fields[a]));
  return filled;
}

}  // namespace tessera::io
