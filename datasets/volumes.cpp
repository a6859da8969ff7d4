// SPDX-License-Identifier: BSD-3-Clause
#include "datasets/volumes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "datasets/fields.hpp"
#include "datasets/volume_fields.hpp"
#include "scene/error.hpp"

namespace tessera::datasets {
namespace {

constexpr double most_points = 4096;

scene::Grid cube_grid(std::int64_t n, int bits) {
  scene::Grid grid;
  grid.geometry.points = {n, n, n};
  grid.geometry.origin = {-1, -1, -1};
  grid.geometry.spacing = glm::dvec3(2.0 / static_cast<double>(n - 1));
  grid.type = bits == 8    ? scene::SampleType::uint8
              : bits == 16 ? scene::SampleType::uint16
                           : scene::SampleType::float32;
  grid.field_name = "f";
  return grid;
}

/// A field on [-1, 1]^3 with values in [0, 1]; null: the checker, which depends on the point's indices.
using Field = double (*)(const glm::dvec3&);

struct Kind {
  const char *name, *help;
  Field field;
  int points;  ///< the default
};
constexpr std::array<Kind, 5> kinds{{
    {"ripples", "volume of a smooth field on [-1, 1]^3, which the benchmarks use", smooth_field, 64},
    {"radial", "volume whose values decrease from its center to its corners", radial_field, 64},
    {"head", "volume of a skull in a case, about half of it empty: values above 0.25 show the skull", head_field, 64},
    {"turbulence", "volume of two fluids that mix, rough everywhere; 0.3 to 0.7: between them", turbulence_field, 64},
    {"checker", "volume whose values alternate between 0 and 1 from point to point", nullptr, 16},
}};

class ComputedVolume final : public scene::SampleSource {
 public:
  ComputedVolume(std::int64_t n, int bits, Field field)
      : SampleSource(cube_grid(n, bits), "generate"), top_(bits == 32 ? 0 : std::exp2(bits) - 1), field_(field) {}

 private:
  void read_samples(const scene::SampleBox& box, const scene::SampleLayout& layout,
                    std::byte* destination) const override {
    const std::size_t size = scene::size_of(layout.type);
    for (std::int64_t k = box.low[2]; k < box.high[2]; ++k)
      for (std::int64_t j = box.low[1]; j < box.high[1]; ++j)
        for (std::int64_t i = box.low[0]; i < box.high[0]; ++i) {
          const glm::dvec3 p = scene::world_of_index(
              geometry(), {static_cast<double>(i), static_cast<double>(j), static_cast<double>(k)});
          const double value = field_ == nullptr ? static_cast<double>((i + j + k) % 2) : field_(p);
          const std::int64_t at =
              (k - box.low[2]) * layout.slice_pitch + (j - box.low[1]) * layout.row_pitch + i - box.low[0];
          put(value, layout.type, destination + static_cast<std::size_t>(at) * size);
        }
  }

  /// Converts a value first to the volume's stored type, then to `type`, so that every reader gets the same number.
  void put(double value, scene::SampleType type, std::byte* to) const {
    if (top_ == 0) {
      const auto stored = static_cast<float>(value);
      scene::convert_samples(reinterpret_cast<const std::byte*>(&stored), scene::SampleType::float32, 1, false, 1, to,
                             type);
    } else if (top_ < 256) {
      const auto stored = static_cast<std::uint8_t>(std::lround(value * top_));
      scene::convert_samples(reinterpret_cast<const std::byte*>(&stored), scene::SampleType::uint8, 1, false, 1, to,
                             type);
    } else {
      const auto stored = static_cast<std::uint16_t>(std::lround(value * top_));
      scene::convert_samples(reinterpret_cast<const std::byte*>(&stored), scene::SampleType::uint16, 1, false, 1, to,
                             type);
    }
  }

  double top_;
  Field field_;
};

}  // namespace

std::vector<Generator> volume_generators() {
  std::vector<Generator> generators;
  for (const Kind& kind : kinds) {
    generators.push_back(
        {kind.name, kind.help, {{"n", static_cast<double>(kind.points), "points per side, 2 to 4096"}}});
    if (kind.field != nullptr)
      generators.back().parameters.push_back({"bits", 32, "8 or 16: whole numbers; 32: floats"});
  }
  return generators;
}

std::unique_ptr<scene::SampleSource> generate_volume(const std::string& kind,
                                                     const std::map<std::string, double>& parameters) {
  const auto known = volume_generators();
  const auto generator = std::find_if(known.begin(), known.end(), [&](const Generator& g) { return g.name == kind; });
  if (generator == known.end())
    throw scene::bad_input(
        fmt::format("generate: '{}' is not a volume; use ripples, radial, head, turbulence or checker", kind));
  std::map<std::string, double> values = with_defaults(kind, generator->parameters, parameters);
  const double n = values["n"], bits = values.count("bits") > 0 ? values["bits"] : 32;
  if (!(n >= 2 && n <= most_points) || n != std::floor(n))
    throw scene::bad_input(fmt::format("generate: n is {}; give a whole number from 2 to 4096", n));
  if (bits != 8 && bits != 16 && bits != 32)
    throw scene::bad_input(fmt::format("generate: bits is {}; give 8, 16 or 32", bits));
  return std::make_unique<ComputedVolume>(static_cast<std::int64_t>(n), static_cast<int>(bits),
                                          kinds[static_cast<std::size_t>(generator - known.begin())].field);
}

}  // namespace tessera::datasets
