// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <functional>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>
#include <glm/vec3.hpp>
#include <iostream>
#include <string>
#include <vector>

#include "support/read_files.hpp"
#include "support/some_cases.hpp"
#include "support/volume_checks.hpp"

/// A volume of a patient with one bright sample, in any of the 48 orientations, to test where a reader places it.
namespace tessera::test {

/// In right-anterior-superior, whatever the format's own frame. The marker is at index {5, 1, 3} of 7 x 6 x 5 samples.
struct MarkedVolume {
  glm::dmat3 axes{1.0};  ///< column a: direction of the file's axis a, a unit vector
  glm::dvec3 spacing{3, 4, 5}, origin{-20, 12, 31};
  static constexpr std::array<int, 3> size{7, 6, 5}, marker{5, 1, 3};

  [[nodiscard]] glm::dvec3 place(const glm::dvec3& index) const { return origin + axes * (spacing * index); }
  [[nodiscard]] glm::dvec3 marker_place() const { return place({marker[0], marker[1], marker[2]}); }
  [[nodiscard]] std::vector<std::int16_t> samples() const {
    std::vector<std::int16_t> values(static_cast<std::size_t>(size[0] * size[1] * size[2]), 1);
    values[static_cast<std::size_t>(marker[0] + size[0] * (marker[1] + size[1] * marker[2]))] = 1000;
    return values;
  }
  /// The letters of the axes' directions: "RAS", "LPI", ...
  [[nodiscard]] std::string letters() const {
    std::string text;
    for (int a = 0; a < 3; ++a)
      for (int k = 0; k < 3; ++k)
        if (axes[a][k] != 0) text += axes[a][k] > 0 ? "RAS"[k] : "LPI"[k];
    return text;
  }
};

inline std::vector<MarkedVolume> all_orientations() {
  std::vector<MarkedVolume> volumes;
  for (const std::array<int, 3>& order : {std::array{0, 1, 2}, std::array{0, 2, 1}, std::array{1, 0, 2},
                                          std::array{1, 2, 0}, std::array{2, 0, 1}, std::array{2, 1, 0}})
    for (int signs = 0; signs < 8; ++signs) {
      MarkedVolume volume;
      volume.axes = glm::dmat3(0.0);
      for (int a = 0; a < 3; ++a) volume.axes[a][order[static_cast<std::size_t>(a)]] = ((signs >> a) & 1) != 0 ? -1 : 1;
      volumes.push_back(volume);
    }
  return volumes;
}

/// Converts from right-anterior-superior to left-posterior-superior, or back.
inline glm::dvec3 turned_to_lps(const glm::dvec3& v) { return {-v.x, -v.y, v.z}; }

/// Position of the brightest sample, in right-anterior-superior; NaN if the file has no anatomical axes.
inline glm::dvec3 found_marker(const io::VolumeFile& volume) {
  const std::vector<double> samples = all_samples(*volume.source);
  const auto at = static_cast<std::int64_t>(std::max_element(samples.begin(), samples.end()) - samples.begin());
  const scene::GridIndex n = volume.source->geometry().samples();
  const glm::dvec3 index(static_cast<double>(at % n[0]), static_cast<double>(at / n[0] % n[1]),
                         static_cast<double>(at / n[0] / n[1]));
  const glm::dvec3 place = scene::world_of_index(volume.source->geometry(), index);
  if (volume.body_axes == BodyAxes::none) return glm::dvec3(std::nan(""));
  return volume.body_axes == BodyAxes::lps ? turned_to_lps(place) : place;
}

struct MarkedFormat {
  std::string name;
  /// Writes the volume and returns the file's name; empty: the format does not support this orientation.
  std::function<std::filesystem::path(const MarkedVolume&)> write;
};

/// Reads every orientation in every format, expects the marker at its position, and prints the table.
inline void expect_markers(const std::vector<MarkedFormat>& formats) {
  std::cout << "axes  marker (R, A, S)  ";
  for (const MarkedFormat& format : formats) std::cout << "| " << format.name << ' ';
  std::cout << '\n';
  SomeCases some(5);
  for (const MarkedVolume& marked : all_orientations()) {
    if (!some.next()) continue;
    const glm::dvec3 wanted = marked.marker_place();
    std::cout << marked.letters() << "   " << wanted.x << ' ' << wanted.y << ' ' << wanted.z << '\t';
    for (const MarkedFormat& format : formats) {
      const std::filesystem::path file = format.write(marked);
      if (file.empty()) {
        std::cout << "| -" << std::string(format.name.size(), ' ');
        continue;
      }
      const io::VolumeFile volume = io::open_volume(file);
      const glm::dvec3 found = found_marker(volume);
      const double off = glm::length(found - wanted);
      EXPECT_LT(off, 1e-4) << format.name << ' ' << marked.letters() << ": " << found.x << ' ' << found.y << ' '
                           << found.z;
      std::cout << "| " << (off < 1e-4 ? "right" : "WRONG")
                << std::string(std::max<std::size_t>(format.name.size(), 5) - 4, ' ');
    }
    std::cout << '\n';
  }
}

}  // namespace tessera::test
