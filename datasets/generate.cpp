// SPDX-License-Identifier: BSD-3-Clause
#include "datasets/generate.hpp"

#include <fmt/format.h>

#include <cmath>
#include <functional>
#include <limits>

#include "datasets/boxes.hpp"
#include "datasets/demo.hpp"
#include "datasets/modify.hpp"
#include "datasets/shapes.hpp"
#include "scene/error.hpp"

namespace tessera::datasets {
namespace {

/// The values of one call: those given, and defaults for the others.
class Values {
 public:
  Values(const std::string& kind, const std::map<std::string, double>& values) : kind_(kind), values_(values) {}

  [[nodiscard]] double real(const std::string& name) const { return values_.at(name); }
  [[nodiscard]] int whole(const std::string& name) const {
    const double v = values_.at(name);
    if (std::floor(v) != v || std::abs(v) > std::numeric_limits<int>::max())
      throw scene::bad_input(fmt::format("{}: {} is {}; give a whole number", kind_, name, v));
    return static_cast<int>(v);
  }
  [[nodiscard]] std::uint64_t seed() const {
    const int v = whole("seed");
    if (v < 0) throw scene::bad_input(fmt::format("{}: seed is {}; give 0 or more", kind_, v));
    return static_cast<std::uint64_t>(v);
  }
  [[nodiscard]] bool flag(const std::string& name) const {
    const double v = values_.at(name);
    if (v != 0 && v != 1) throw scene::bad_input(fmt::format("{}: {} is {}; give 0 or 1", kind_, name, v));
    return v == 1;
  }

 private:
  const std::string& kind_;
  const std::map<std::string, double>& values_;
};

struct Recipe {
  Generator generator;
  std::function<scene::TetMesh(const Values&)> make;
};

std::vector<Recipe> recipes() {
  const GeneratorParameter seed{"seed", 7, "of the random numbers"};
  return {
      {{"demo", "a wake behind a cylinder: an image to start with", {{"resolution", 1, "1 is about 0.52 M tets"}}},
       [](const Values& v) { return demo(v.real("resolution")); }},
      {{"cube",
        "n^3 voxels of six tets, inner vertices jittered, smooth field",
        {{"n", 32, "voxels a side"}, {"jitter", 0.2, "in voxels, 0 .. 0.25"}, seed}},
       [](const Values& v) { return cube(v.whole("n"), v.real("jitter"), v.seed()); }},
      {{"regular",
        "nx x ny x nz voxels of six tets with exact coordinates",
        {{"nx", 16, "voxels"}, {"ny", 16, "voxels"}, {"nz", 16, "voxels"}, {"spacing", 0.125, "voxel edge"}}},
       [](const Values& v) {
         return regular_split(v.whole("nx"), v.whole("ny"), v.whole("nz"), glm::dvec3(v.real("spacing")));
       }},
      {{"graded",
        "voxels that shrink towards the centre",
        {{"n", 32, "voxels per side, an even number"},
         {"volume_ratio", 1e6, "ratio of the largest to the smallest cell, 1 .. 1e15"}}},
       [](const Values& v) { return graded(v.whole("n"), v.real("volume_ratio")); }},
      {{"slivers",
        "voxels with nearly flat tets between layers",
        {{"n", 16, "voxels a side"}, {"aspect", 1e4, "ratio of a sliver's width to its height, n * n .. 1e15"}}},
       [](const Values& v) { return slivers(v.whole("n"), v.real("aspect")); }},
      {{"stack",
        "a pile of thin cells behind a few pixels, in a shallow plate",
        {{"layers", 20000, "thin voxels"},
         {"width", 0.02, "width of the pile, 0 .. 0.4"},
         {"thickness", 1, "thickness of the pile"}}},
       [](const Values& v) { return thin_stack(v.whole("layers"), v.real("width"), v.real("thickness")); }},
      {{"ball", "the unit ball", {{"levels", 4, "8^(levels + 1) tets, 0 .. 7"}}},
       [](const Values& v) { return ball(v.whole("levels")); }},
      {{"annulus",
        "a thick ring: not convex, one hole",
        {{"n", 64, "hexahedra around the ring"}, {"seam", 0, "1: close the ring with coincident vertices"}}},
       [](const Values& v) { return annulus(v.whole("n"), v.flag("seam")); }},
      {{"shells",
        "concentric shells: several parts inside one another",
        {{"count", 4, "shells, 1 .. 20"}, {"levels", 3, "subdivisions of the sphere"}, {"layers", 2, "a shell"}}},
       [](const Values& v) { return shells(v.whole("count"), v.whole("levels"), v.whole("layers")); }},
      {{"bars", "three bars that overlap in a cycle", {{"n", 16, "hexahedra per bar"}}},
       [](const Values& v) { return cyclic_bars(v.whole("n")); }},
      {{"tet", "one tetrahedron", {}}, [](const Values&) { return single_tet(); }},
  };
}

std::string names(const std::vector<GeneratorParameter>& parameters) {
  std::string list;
  for (const GeneratorParameter& p : parameters) list += (list.empty() ? "" : ", ") + p.name;
  return list;
}

scene::TetMesh apply_common(scene::TetMesh mesh, const Values& v) {
  const int inversion = v.whole("inverted"), group = v.whole("cell_data"), levels = v.whole("subdivide");
  if (inversion < 0 || inversion > 2)
    throw scene::bad_input(fmt::format("inverted is {}; give 0 (no), 1 (all) or 2 (every other tet)", inversion));
  if (group < 0) throw scene::bad_input(fmt::format("cell_data is {}; give 0 or the number of tets per cell", group));
  if (levels < 0 || levels > 5) throw scene::bad_input(fmt::format("subdivide is {}; give 0 .. 5", levels));
  if (inversion == 1) mesh = inverted(std::move(mesh), Orientation::all_inverted);
  if (inversion == 2) mesh = inverted(std::move(mesh), Orientation::every_other_inverted);
  if (group > 0) mesh = with_cell_data(std::move(mesh), group);
  for (int level = 0; level < levels; ++level) mesh = subdivided(mesh);
  if (v.whole("shuffle") != 0) mesh = shuffled(mesh, static_cast<std::uint64_t>(v.whole("shuffle")));
  const double scale = v.real("scale"), offset = v.real("offset");
  if (!(scale > 0) || !std::isfinite(scale) || !std::isfinite(offset))
    throw scene::bad_input(
        fmt::format("scale is {} and offset {}; both must be finite, and the scale positive", scale, offset));
  if (scale != 1 || offset != 0) mesh = transformed(std::move(mesh), scale, glm::dvec3(offset));
  return mesh;
}

}  // namespace

std::vector<Generator> generators() {
  std::vector<Generator> out;
  for (Recipe& r : recipes()) out.push_back(std::move(r.generator));
  return out;
}

std::vector<GeneratorParameter> common_parameters() {
  return {{"inverted", 0, "1: all tets left-handed, 2: every other one"},
          {"cell_data", 0, "k > 0: average the field over cells of k tets"},
          {"subdivide", 0, "number of times that every tet is cut into eight"},
          {"shuffle", 0, "a seed > 0: tets and vertices in random order"},
          {"scale", 1, "multiplies coordinates"},
          {"offset", 0, "added to every coordinate"}};
}

std::map<std::string, double> with_defaults(const std::string& kind, const std::vector<GeneratorParameter>& known,
                                            const std::map<std::string, double>& given) {
  std::map<std::string, double> values;
  for (const GeneratorParameter& p : known) values[p.name] = p.default_value;
  for (const auto& [name, value] : given) {
    if (!values.contains(name))
      throw scene::bad_input(fmt::format("{}: unknown parameter '{}'; it takes {}", kind, name, names(known)));
    values[name] = value;
  }
  return values;
}

scene::TetMesh generate(const std::string& kind, const std::map<std::string, double>& parameters) {
  std::string kinds;
  for (const Recipe& recipe : recipes()) {
    const Generator& g = recipe.generator;
    kinds += (kinds.empty() ? "" : ", ") + g.name;
    if (g.name != kind) continue;
    std::vector<GeneratorParameter> known = g.parameters;
    for (const GeneratorParameter& p : common_parameters()) known.push_back(p);
    const std::map<std::string, double> values = with_defaults(kind, known, parameters);
    const Values v(g.name, values);
    return apply_common(recipe.make(v), v);
  }
  throw scene::bad_input(fmt::format("unknown kind '{}'; kinds are {}", kind, kinds));
}

}  // namespace tessera::datasets
