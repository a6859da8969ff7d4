// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "io/mesh/nastran_deck.hpp"

namespace tessera::io {

/// The points (GRID) of a Nastran deck and the coordinate systems (CORD1R, 1C, 1S, 2R, 2C, 2S) in which they are given.
///
/// Source  MSC Nastran, "Quick Reference Guide", bulk data entries CORDij, GRDSET and GRID.
class NastranSystems {
 public:
  static bool is_used(std::string_view entry);

  /// Adds an entry that is_used() accepts.
  void add(const NastranEntry& entry);

  /// Computes the positions of the points; must be called after all entries have been added. Throws Error(bad_input)
  /// naming `source` for a coordinate system that is missing, unsupported, degenerate, or defined by itself.
  void place_points(const std::string& source);

  /// The index of a point in positions(); no value if the deck does not contain it.
  [[nodiscard]] std::optional<std::uint32_t> point(std::int64_t id) const;
  [[nodiscard]] const std::vector<glm::dvec3>& positions() const { return positions_; }

 private:
  enum class Kind : char { rectangular = 'R', cylindrical = 'C', spherical = 'S' };
  enum class Progress : std::uint8_t { none, begun, done };
  struct Point {
    std::int64_t id = 0, system = 0;
    bool has_system = false;
    glm::dvec3 given{};
    Progress progress = Progress::none;
  };
  struct System {
    Kind kind = Kind::rectangular;
    bool of_points = false;  ///< the system is defined by three points, whose ids are in `points`
    std::array<std::int64_t, 3> points{};
    std::int64_t reference = 0;           ///< the system in which the three points of `corners` are given
    std::array<glm::dvec3, 3> corners{};  ///< origin, a point on the z axis, a point in the xz plane
    glm::dvec3 origin{};
    glm::dmat3 axes{1};
    Progress progress = Progress::none;
  };

  void add_point(const NastranEntry& entry);
  [[nodiscard]] std::size_t find(std::int64_t id) const;
  const System& system(std::int64_t id, const std::string& user);
  const glm::dvec3& place(std::size_t point);
  glm::dvec3 in_basic(std::int64_t system, const glm::dvec3& p, const std::string& user);

  std::vector<Point> points_;  ///< sorted by id once all are added
  std::map<std::int64_t, System> systems_;
  std::map<std::int64_t, std::string> unread_;  ///< unsupported systems and the names of their entries
  std::int64_t default_system_ = 0;
  std::vector<glm::dvec3> positions_;
  std::string source_;
  std::size_t depth_ = 0;
};

}  // namespace tessera::io
