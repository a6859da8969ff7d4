#pragma once

#include <bit>
#include <cstdint>
#include <glm/vec3.hpp>
#include <span>

#include "scene/tet_mesh.hpp"

namespace tessera::io {

/// Cells of a mesh whose tets have the corners of an earlier cell's by position: parts that were put together several
/// times. Each of them is drawn twice as dense as it is.
///
/// Takes   O(tets) time, and for its duration 8 bytes a vertex and 6 a cell; 16 more for each duplicate. On a mesh that
///         is read fast that is more than half of the time of reading, so DuplicateSample looks first.
/// Returns how many there are. With `drop` their tets are removed; vertices stay, and original_cell has the cells'
///         numbers as they were.
std::uint64_t find_duplicate_cells(scene::TetMesh& mesh, bool drop, int threads);

/// A number that depends on a place alone; -0 and 0 differ.
inline std::uint64_t hash_of_place(const glm::dvec3& p) {
  const auto word = [](double x, std::uint64_t odd, int turn) {
    return std::rotl(std::bit_cast<std::uint64_t>(x) * odd, turn);
  };
  const std::uint64_t sum =
      word(p.x, 0x9e3779b97f4a7c15, 0) ^ word(p.y, 0xbf58476d1ce4e5b9, 21) ^ word(p.z, 0x94d049bb133111eb, 42);
  return (sum ^ sum >> 32) * 0xff51afd7ed558ccd;
}

/// Tells in little time whether a mesh may have duplicate cells: it looks at the tets of some 4,096 places alone, which
/// their coordinates choose. A part that is there twice is found if one of those is in it: one of a five-hundredth of
/// the mesh's points with a probability of 0.9997. Of small meshes it takes all.
class DuplicateSample {
 public:
  explicit DuplicateSample(const scene::TetMesh& mesh)
      : takes_all_(mesh.tets.size() <= std::size_t{1} << 16 || mesh.positions.size() <= places),
        limit_(takes_all_ ? 0 : ~std::uint64_t{0} / mesh.positions.size() * places) {}

  [[nodiscard]] bool takes_all() const { return takes_all_; }
  [[nodiscard]] bool has(const glm::dvec3& place) const { return hash_of_place(place) < limit_; }

  /// Whether some of the tets at those places have the same corners.
  static bool has_repetitions(const scene::TetMesh& mesh, std::span<const std::size_t> tets);

 private:
  static constexpr std::size_t places = 4096;
  bool takes_all_;
  std::uint64_t limit_;
};

}  // namespace tessera::io
