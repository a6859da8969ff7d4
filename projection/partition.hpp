// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <compare>
#include <cstdint>
#include <span>
#include <vector>

#include "scene/camera.hpp"
#include "scene/tet_mesh.hpp"
#include "tessera/settings.hpp"

/// Assigns the tets of a mesh to processes for projection. Pure functions: each process calls them for the tets that it
/// has, and all processes get the same owner for a tet.
namespace tessera::projection {

using tessera::Partition;
using tessera::PartitionKind;

/// Part of each of the tets [0, total) in file order: part sizes differ by at most one tet, and the first parts are the
/// larger ones. `parts` > 0; tet < total.
int part_in_file_order(std::uint64_t tet, std::uint64_t total, int parts);

/// The first tet of a part in file order; `total` for part == parts.
std::uint64_t first_in_file_order(int part, std::uint64_t total, int parts);

/// Part by a hash of tet and seed (Steele, Lea, Flood, "Fast Splittable Pseudorandom Number Generators", OOPSLA 2014).
int part_at_random(std::uint64_t tet, std::uint64_t seed, int parts);

/// A tet's position in the order along the curve. Tets at the same place are in file order.
struct CurveKey {
  std::uint64_t place;  ///< curve_place of its centroid
  std::uint64_t tet;    ///< index in the whole mesh

  auto operator<=>(const CurveKey&) const = default;  // NOLINT(modernize-use-nullptr): there is none
};

/// Position of a point along the Hilbert curve through the cube on the box's longest side, with 2^21 steps per axis:
/// below 2^63. Points outside the cube are moved to its boundary; a box without extent gives 0. Source: Skilling,
/// "Programming the Hilbert curve", AIP Conference Proceedings 707, 2004.
std::uint64_t curve_place(const glm::dvec3& point, const scene::Box& box);

/// Keys of the mesh's tets. `box` is that of the whole mesh; `global_tet` are the tets' indices in the whole mesh, or
/// empty if `mesh` is the whole. Uses all threads of the caller's arena.
std::vector<CurveKey> curve_keys(const scene::TetMeshView& mesh, std::span<const std::uint64_t> global_tet,
                                 const scene::Box& box);

/// Cuts the list of all processes' keys, in curve order, into parts of equal size by counting alone: no process stores
/// or sorts the whole list. Part sizes differ from total / parts by less than 1 % of it, or by one tet.
///
///     CurveCut cut(total, parts);
///     while (!cut.done()) cut.narrow(sum over all processes of cut.count(my keys));
///
/// Each round examines 8 or more further bits of the keys: two or three rounds for typical meshes, at most 15. The
/// result depends only on the set of keys, not on their distribution over processes.
class CurveCut {
 public:
  /// parts > 0.
  CurveCut(std::uint64_t total, int parts);

  [[nodiscard]] bool done() const { return open_.empty(); }

  /// The number of these keys in each bin that may still contain a splitter.
  [[nodiscard]] std::vector<std::uint64_t> count(std::span<const CurveKey> keys) const;

  /// Takes the sums of the counts of all processes.
  void narrow(std::span<const std::uint64_t> counts);

  /// parts - 1 keys, ascending: part p begins with the first key >= splitters()[p - 1]. Only once done().
  [[nodiscard]] const std::vector<CurveKey>& splitters() const { return splitters_; }

 private:
  /// Keys that agree in all bits examined so far, with at least one splitter among them.
  struct Bin {
    CurveKey first;       ///< smallest key of the bin
    std::uint64_t below;  ///< number of keys of all processes before the bin
  };
  /// A splitter that is not determined yet.
  struct Open {
    std::size_t splitter, bin;
    std::uint64_t target;  ///< number of keys that should be before it
  };

  std::uint64_t tolerance_;
  int depth_ = 0;  ///< bits examined so far, of 128
  std::vector<Bin> bins_;
  std::vector<Open> open_;
  std::vector<CurveKey> splitters_;
};

/// Part of a key: the number of splitters that are not greater.
int part_on_curve(const CurveKey& key, std::span<const CurveKey> splitters);

/// Part of each tet of a mesh that this process has as a whole: the same as several processes get.
std::vector<std::uint32_t> parts_of_whole(const scene::TetMeshView& mesh, const Partition& how, int parts);

}  // namespace tessera::projection
