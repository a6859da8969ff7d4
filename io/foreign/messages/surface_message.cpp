// SPDX-License-Identifier: BSD-3-Clause
#include "io/foreign/messages/surface_message.hpp"

#include <cstring>
#include <nlohmann/json.hpp>
#include <stdexcept>

namespace tessera::io {
namespace {

using Json = nlohmann::json;

template <class T>
Json packed(const std::vector<T>& values) {
  std::vector<std::uint8_t> bytes(values.size() * sizeof(T));
  if (!bytes.empty()) std::memcpy(bytes.data(), values.data(), bytes.size());
  return Json::binary(std::move(bytes));
}

template <class T>
std::vector<T> unpacked(const Json& json) {
  const auto& bytes = json.get_binary();
  if (bytes.size() % sizeof(T) != 0) throw std::invalid_argument("numbers cut short");
  std::vector<T> values(bytes.size() / sizeof(T));
  if (!values.empty()) std::memcpy(values.data(), bytes.data(), bytes.size());
  return values;
}

/// Returns the next number of a list.
template <class T>
T next(const std::vector<T>& values, std::size_t& at) {
  if (at >= values.size()) throw std::invalid_argument("a list too short");
  return values[at++];
}

}  // namespace

Json json_of(const cells::Surface& surface) {
  std::vector<std::uint32_t> counts, corners;  // per facet: number of polygons, their lengths, number of holes
  std::vector<glm::dvec3> holes;
  for (const cells::Facet& facet : surface.facets) {
    counts.push_back(static_cast<std::uint32_t>(facet.polygons.size()));
    for (const cells::Polygon& polygon : facet.polygons) {
      counts.push_back(static_cast<std::uint32_t>(polygon.size()));
      corners.insert(corners.end(), polygon.begin(), polygon.end());
    }
    counts.push_back(static_cast<std::uint32_t>(facet.holes.size()));
    holes.insert(holes.end(), facet.holes.begin(), facet.holes.end());
  }
  Json attributes = Json::array();
  for (const std::vector<double>& values : surface.attributes) attributes.push_back(packed(values));
  return {
      {"points", packed(surface.points)},   {"facets", surface.facets.size()}, {"counts", packed(counts)},
      {"corners", packed(corners)},         {"holes", packed(holes)},          {"cavities", packed(surface.cavities)},
      {"attributes", std::move(attributes)}};
}

cells::Surface surface_of(const Json& json) {
  cells::Surface surface;
  surface.points = unpacked<glm::dvec3>(json.at("points"));
  const auto counts = unpacked<std::uint32_t>(json.at("counts")), corners = unpacked<std::uint32_t>(json.at("corners"));
  const auto holes = unpacked<glm::dvec3>(json.at("holes"));
  std::size_t count = 0, corner = 0, hole = 0;
  for (auto facets = json.at("facets").get<std::size_t>(); facets > 0; --facets) {
    cells::Facet facet;
    for (std::uint32_t polygons = next(counts, count); polygons > 0; --polygons) {
      cells::Polygon polygon;
      for (std::uint32_t n = next(counts, count); n > 0; --n) {
        polygon.push_back(next(corners, corner));
        if (polygon.back() >= surface.points.size()) throw std::invalid_argument("a corner that is not a point");
      }
      facet.polygons.push_back(std::move(polygon));
    }
    for (std::uint32_t n = next(counts, count); n > 0; --n) facet.holes.push_back(next(holes, hole));
    surface.facets.push_back(std::move(facet));
  }
  surface.cavities = unpacked<glm::dvec3>(json.at("cavities"));
  for (const Json& values : json.at("attributes")) {
    surface.attributes.push_back(unpacked<double>(values));
    if (surface.attributes.back().size() != surface.points.size()) throw std::invalid_argument("too few attributes");
  }
  return surface;
}

}  // namespace tessera::io
