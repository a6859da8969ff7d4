// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <compare>
#include <cstdint>
#include <span>
#include <vector>

#include "scene/camera.hpp"
#include "scene/tet_mesh.hpp"
#include "tessera/settings.hpp"

/// Assigns the tets of a mesh to processes for projection. The functions are pure: each process calls them for the tets
/// that it has, and all processes compute the same owner for a tet.
namespace tessera::projection {

using tessera::Partition;
using tessera::PartitionKind;

/// Returns the part of a tet in file order. Part sizes differ by at most one tet, and the first parts are the larger
/// ones. Requires `parts` > 0 and tet < total.
int part_in_file_order(std::uint64_t tet, std::uint64_t total, int parts);

/// Returns the first tet of a part in file order; `total` if part == parts.
std::uint64_t first_in_file_order(int part, std::uint64_t total, int parts);

/// Returns a part that is a hash of tet and seed (Steele, Lea, Flood, "Fast Splittable Pseudorandom Number Generators",
/// OOPSLA 2014).
int part_at_random(std::uint64_t tet, std::uint64_t seed, int parts);

/// A tet's position in the order along the curve. Tets at the same position are in file order.
struct CurveKey {
  std::uint64_t place;  ///< curve_place() of the tet's centroid
  std::uint64_t tet;    ///< index in the whole mesh

  auto operator<=>(const CurveKey&) const = default;  // NOLINT(modernize-use-nullptr): there is none
};

/// Returns the position of a point along the Hilbert curve through the cube over the box's longest side, with 2^21
/// steps per axis; the result is below 2^63. Points outside the cube are moved to its boundary; a box without extent
/// gives 0. Source: Skilling, "Programming the Hilbert curve", AIP Conference Proceedings 707, 2004.
std::uint64_t curve_place(const glm::dvec3& point, const scene::Box& box);

/// Returns the keys of the mesh's tets. `box` is that of the whole mesh; `global_tet` contains the tets' indices in the
/// whole mesh, or is empty if `mesh` is the whole mesh. Uses all threads of the caller's arena.
std::vector<CurveKey> curve_keys(const scene::TetMeshView& mesh, std::span<const std::uint64_t> global_tet,
                                 const scene::Box& box);

/// Divides the list of all processes' keys, in curve order, into parts of equal size. It only counts keys, so that no
/// process stores or sorts the whole list. Part sizes differ from total / parts by less than 1 %, or by one tet.
///
///     CurveCut cut(total, parts);
///     while (!cut.done()) cut.narrow(sum over all processes of cut.count(my keys));
///
/// Each round examines at least 8 further bits of the keys. Typical meshes need two or three rounds, and no mesh more
/// than 15. The result depends only on the set of keys, not on their distribution over processes.
class CurveCut {
 public:
  /// `parts` must be positive.
  CurveCut(std::uint64_t total, int parts);

  [[nodiscard]] bool done() const { return open_.empty(); }

  /// Returns how many of these keys are in each bin that may still contain a splitter.
  [[nodiscard]] std::vector<std::uint64_t> count(std::span<const CurveKey> keys) const;

  /// Processes the counts of a round, summed over all processes.
  void narrow(std::span<const std::uint64_t> counts);

  /// Returns parts - 1 keys, ascending: part p begins with the first key >= splitters()[p - 1]. Only valid once done()
  /// is true.
  [[nodiscard]] const std::vector<CurveKey>& splitters() const { return splitters_; }

 private:
  /// A set of keys that agree in all bits examined so far, and that contains at least one splitter.
  struct Bin {
    CurveKey first;       ///< smallest key of the bin
    std::uint64_t below;  ///< number of keys of all processes before the bin
  };
  /// A splitter that is not determined yet.
  struct Open {
    std::size_t splitter, bin;
    std::uint64_t target;  ///< number of keys that should be before the splitter
  };

  std::uint64_t tolerance_;
  int depth_ = 0;  ///< bits examined so far, of 128
  std::vector<Bin> bins_;
  std::vector<Open> open_;
  std::vector<CurveKey> splitters_;
};

/// Returns the part of a key: the number of splitters that are not greater than the key.
int part_on_curve(const CurveKey& key, std::span<const CurveKey> splitters);

/// Returns the part of each tet of a mesh that this process has as a whole. The result is the same as that of several
/// processes.
std::vector<std::uint32_t> parts_of_whole(const scene::TetMeshView& mesh, const Partition& how, int parts);

}  // namespace tessera::projection
