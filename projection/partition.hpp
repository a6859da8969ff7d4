// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <compare>
#include <cstdint>
#include <span>
#include <vector>

#include "scene/camera.hpp"
#include "scene/tet_mesh.hpp"
#include "tessera/settings.hpp"

/// Which of several processes projects which tet of a mesh. Pure functions: each process asks them about the tets it
/// happens to hold, and all find the same owner for a tet whoever asks.
namespace tessera::projection {

using tessera::Partition;
using tessera::PartitionKind;

/// Part of each of the tets [0, total) in file order: parts differ by one tet at most, the first ones are the larger.
/// `parts` > 0; tet < total.
int part_in_file_order(std::uint64_t tet, std::uint64_t total, int parts);

/// The first tet of a part in file order; `total` for part == parts.
std::uint64_t first_in_file_order(int part, std::uint64_t total, int parts);

/// Part by a hash of tet and seed (Steele, Lea, Flood, "Fast Splittable Pseudorandom Number Generators", OOPSLA 2014).
int part_at_random(std::uint64_t tet, std::uint64_t seed, int parts);

/// A tet's place in the order along the curve. Tets at one place follow each other in file order.
struct CurveKey {
  std::uint64_t place;  ///< curve_place of its centroid
  std::uint64_t tet;    ///< index in the whole mesh

  auto operator<=>(const CurveKey&) const = default;  // NOLINT(modernize-use-nullptr): there is none
};

/// Where a point lies along the Hilbert curve through the cube over the box's longest side, in 2^21 steps an axis:
/// below 2^63. Points outside count as the cube's nearest; a box of no extent gives 0.
/// Source: Skilling, "Programming the Hilbert curve", AIP Conference Proceedings 707, 2004.
std::uint64_t curve_place(const glm::dvec3& point, const scene::Box& box);

/// Keys of the mesh's tets. `box` is the whole mesh's; `global_tet` their indices in the whole, or empty if the mesh is
/// the whole. Uses all threads of the caller's arena.
std::vector<CurveKey> curve_keys(const scene::TetMeshView& mesh, std::span<const std::uint64_t> global_tet,
                                 const scene::Box& box);

/// Cuts the list of all processes' keys, in curve order, into parts of equal number by counting alone: nobody holds or
/// sorts the list. Part sizes differ from total / parts by less than 1 % of it, or by one tet.
///
///     CurveCut cut(total, parts);
///     while (!cut.done()) cut.narrow(sum over all processes of cut.count(my keys));
///
/// Each round looks 8 or more bits deeper into the keys: two or three rounds for meshes as they come, 15 at most. The
/// result depends on the set of keys only, not on who held which.
class CurveCut {
 public:
  /// parts > 0.
  CurveCut(std::uint64_t total, int parts);

  [[nodiscard]] bool done() const { return open_.empty(); }

  /// How many of these keys lie in each of the bins that are still of interest.
  [[nodiscard]] std::vector<std::uint64_t> count(std::span<const CurveKey> keys) const;

  /// Takes the counts of all processes together.
  void narrow(std::span<const std::uint64_t> counts);

  /// parts - 1 keys, ascending: part p begins with the first key >= splitters()[p - 1]. Once done().
  [[nodiscard]] const std::vector<CurveKey>& splitters() const { return splitters_; }

 private:
  /// Keys that agree in all bits looked at so far, among which one splitter or more lies.
  struct Bin {
    CurveKey first;       ///< smallest key of the bin
    std::uint64_t below;  ///< keys of all processes before the bin
  };
  /// A splitter that is not settled yet.
  struct Open {
    std::size_t splitter, bin;
    std::uint64_t target;  ///< keys that should lie before it
  };

  std::uint64_t tolerance_;
  int depth_ = 0;  ///< bits looked at, of 128
  std::vector<Bin> bins_;
  std::vector<Open> open_;
  std::vector<CurveKey> splitters_;
};

/// Part of a key: how many splitters are not greater.
int part_on_curve(const CurveKey& key, std::span<const CurveKey> splitters);

/// Part of each tet of a mesh that is whole in this process: the same as several processes find.
std::vector<std::uint32_t> parts_of_whole(const scene::TetMeshView& mesh, const Partition& how, int parts);

}  // namespace tessera::projection
