// SPDX-License-Identifier: BSD-3-Clause
// The only file that includes TetGen, which is under the AGPL-3.0.
#include <fmt/format.h>

#define TETLIBRARY
// TetGen's own terminatetetgen, defined in its header, frees the mesh and then throws; the mesh's destructor frees it
// again, which crashes. The library calls that function through the dynamic linker, so the function defined below
// replaces it. For that, it must be visible.
#define terminatetetgen tetgen_header_terminatetetgen
#include <tetgen.h>
#undef terminatetetgen

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <glm/common.hpp>
#include <new>
#include <nlohmann/json.hpp>
#include <vector>

#include "io/foreign/messages/surface_message.hpp"
#include "readers/common/readers.hpp"
#include "readers/tetgen/surface_fields.hpp"
#include "scene/error.hpp"

__attribute__((visibility("default"))) void terminatetetgen(tetgenmesh*, int reason) { throw reason; }

namespace tessera::readers {
namespace {

/// Returns the message for a number that TetGen throws (terminatetetgen in tetgen.h).
const char* reason(int thrown) {
  switch (thrown) {
    case 3:
      return "the surface cuts itself";
    case 4:
      return "a feature is too small for its tolerance";
    case 5:
      return "two faces nearly coincide";
    case 10:
      return "the input is not valid";
    default:
      return "it failed inside";
  }
}

/// Maps a surface to the unit box around the origin and back. The scale is a power of two. Needed because TetGen's
/// tolerances do not work for metre-size cells at coordinates of 7e6.
struct Frame {
  glm::dvec3 centre{0};
  double scale = 1;

  explicit Frame(const cells::Surface& surface) {
    glm::dvec3 low(1e300), high(-1e300);
    for (const glm::dvec3& p : surface.points) low = glm::min(low, p), high = glm::max(high, p);
    centre = 0.5 * low + 0.5 * high;
    const glm::dvec3 side = high - low;
    int exponent = 0;
    std::frexp(std::max({side.x, side.y, side.z}), &exponent);
    scale = std::ldexp(1.0, -exponent);
  }
  [[nodiscard]] glm::dvec3 in(const glm::dvec3& p) const { return (p - centre) * scale; }
  [[nodiscard]] glm::dvec3 out(const glm::dvec3& p) const { return p / scale + centre; }
};

tetgenio* keep_for_good() {
  static std::vector<tetgenio*> kept;
  kept.push_back(new tetgenio);
  return kept.back();
}

/// Copies a surface to tetgenio, which frees its arrays by delete[]; so they are allocated by new[].
void copy_in(const cells::Surface& surface, const Frame& frame, tetgenio& in) {
  const auto put = [&](REAL* list, std::size_t at, const glm::dvec3& p_world) {
    const glm::dvec3 p = frame.in(p_world);
    for (int k = 0; k < 3; ++k) list[3 * at + static_cast<std::size_t>(k)] = p[k];
  };
  in.numberofpoints = static_cast<int>(surface.points.size());
  in.pointlist = new REAL[3 * surface.points.size()];
  for (std::size_t v = 0; v < surface.points.size(); ++v) put(in.pointlist, v, surface.points[v]);
  in.facetlist = new tetgenio::facet[surface.facets.size()];
  for (std::size_t f = 0; f < surface.facets.size(); ++f) {
    const cells::Facet& from = surface.facets[f];
    tetgenio::facet& to = in.facetlist[f];
    tetgenio::init(&to);
    in.numberoffacets = static_cast<int>(f) + 1;
    to.polygonlist = new tetgenio::polygon[from.polygons.size()];
    for (const cells::Polygon& polygon : from.polygons) {
      tetgenio::polygon& corners = to.polygonlist[to.numberofpolygons++];
      tetgenio::init(&corners);
      corners.vertexlist = new int[polygon.size()];
      corners.numberofvertices = static_cast<int>(polygon.size());
      std::copy(polygon.begin(), polygon.end(), corners.vertexlist);
    }
    if (!from.holes.empty()) {
      to.holelist = new REAL[3 * from.holes.size()];
      for (const glm::dvec3& hole : from.holes) put(to.holelist, static_cast<std::size_t>(to.numberofholes++), hole);
    }
  }
  if (!surface.cavities.empty()) {
    in.holelist = new REAL[3 * surface.cavities.size()];
    for (const glm::dvec3& cavity : surface.cavities)
      put(in.holelist, static_cast<std::size_t>(in.numberofholes++), cavity);
  }
}

/// Describes where a surface intersects itself, in words that follow "the surface cuts itself"; empty if TetGen does
/// not find the place.
std::string place_of_cut(const cells::Surface& surface, const Frame& frame) {
  tetgenbehavior settings;
  std::string switches = "dzQ";  // d: find intersecting faces
  settings.parse_commandline(switches.data());
  tetgenio* const in = keep_for_good();
  tetgenio* const out = keep_for_good();
  copy_in(surface, frame, *in);
  try {
    tetrahedralize(&settings, in, out);
  } catch (int) {
    return {};
  }
  if (out->numberoftrifaces <= 0 || out->trifacelist == nullptr || out->pointlist == nullptr) return {};
  glm::dvec3 middle(0);
  for (int k = 0; k < 3; ++k) {
    const int v = out->trifacelist[k];
    if (v < 0 || v >= out->numberofpoints) return {};
    const REAL* const p = out->pointlist + 3 * static_cast<std::size_t>(v);
    middle += frame.out({p[0], p[1], p[2]}) / 3.0;
  }
  return fmt::format(" in {} faces, one about ({:.6g}, {:.6g}, {:.6g})", out->numberoftrifaces, middle.x, middle.y,
                     middle.z);
}

}  // namespace

FilledSurface fill(const cells::Surface& surface, std::optional<double> max_volume, const std::string& source) {
  if (surface.points.size() > static_cast<std::size_t>(INT32_MAX) / 8)
    throw scene::bad_input(
        fmt::format("{}: {} points are too many for TetGen; coarsen the surface", source, surface.points.size()));
  const Frame frame(surface);
  tetgenbehavior settings;
  // p: fill a closed complex, q: quality, z: count from 0, Q: quiet
  std::string switches = max_volume ? "pq2.0zQ" : "pzQ";
  settings.parse_commandline(switches.data());
  if (max_volume) {
    settings.fixedvolume = 1;  // -a
    settings.maxvolume = *max_volume * frame.scale * frame.scale * frame.scale;
  }
  // Never freed, because TetGen's destructors may crash after a failure, and the process ends soon.
  tetgenio* const in = keep_for_good();
  tetgenio* const out = keep_for_good();
  copy_in(surface, frame, *in);
  try {
    tetrahedralize(&settings, in, out);
  } catch (int thrown) {
    if (thrown == 1) throw std::bad_alloc();
    throw scene::bad_input(fmt::format("{}: TetGen cannot fill the surface: {}{}; correct the surface", source,
                                       reason(thrown), thrown == 3 || thrown == 5 ? place_of_cut(surface, frame) : ""));
  }
  FilledSurface filled;
  const auto points = static_cast<std::size_t>(out->numberofpoints);
  for (std::size_t v = 0; v < points; ++v) {  // TetGen's output begins with the points of the surface
    const REAL* const p = out->pointlist + 3 * v;
    filled.points.push_back(v < surface.points.size() ? surface.points[v] : frame.out({p[0], p[1], p[2]}));
  }
  filled.tets.assign(out->tetrahedronlist,
                     out->tetrahedronlist + 4 * static_cast<std::size_t>(out->numberoftetrahedra));
  filled.triangles.assign(out->trifacelist, out->trifacelist + 3 * static_cast<std::size_t>(out->numberoftrifaces));
  if (filled.tets.empty())
    throw scene::bad_input(
        fmt::format("{}: TetGen finds nothing inside the surface: it is not closed; close its holes", source));
  return filled;
}

namespace {

io::ForeignContents fill_with_fields(Holdings& holdings, const cells::Surface& surface, const std::string& source,
                                     const nlohmann::json& request) {
  FilledSurface filled = fill(surface, request.at("max_volume").get<double>(), source);
  io::ForeignPart part;
  const auto add = [&](std::vector<double> values) {
    part.point_fields.push_back(hold_vector(holdings, {}, std::move(values)));
  };
  add(depth_below_surface(filled));
  if (!surface.attributes.empty())
    for (std::vector<double>& values : spread_attributes(surface, fill(surface, std::nullopt, source), filled))
      add(std::move(values));
  part.points = hold_vector(holdings, {.components = 3}, std::move(filled.points));
  part.connectivity = hold_vector(holdings, {.type = NumberType::uint32}, std::move(filled.tets));
  return {.parts = {std::move(part)}, .notes = {}, .format = "TetGen"};
}

}  // namespace

io::ForeignContents fill_surface(Holdings& holdings, const std::filesystem::path& file, const nlohmann::json& request) {
  const std::string source = file.string();
  const cells::Surface surface = io::surface_of(request.at("surface"));
  allow_filling(surface.facets.size(), request.at("tets").get<double>(), request.at("is_chosen").get<bool>());
  try {
    return fill_with_fields(holdings, surface, source, request);
  } catch (const std::bad_alloc&) {
    throw memory_error(source, fmt::format("filling it by TetGen takes much more memory than {} facets should take; {}",
                                           surface.facets.size(), request.at("limit_remedy").get<std::string>()));
  }
}

}  // namespace tessera::readers
