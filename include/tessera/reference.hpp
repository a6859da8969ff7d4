// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "tessera/camera.hpp"
#include "tessera/dataset.hpp"
#include "tessera/export.hpp"
#include "tessera/settings.hpp"
#include "tessera/transfer_function.hpp"
#include "tessera/view.hpp"

namespace tessera {
inline namespace v0_1 {

/// The result for one ray.
struct ReferencePixel {
  double r = 0, g = 0, b = 0, a = 0;  ///< linear RGB premultiplied by a; a = 1 - transmittance
  double z = 0;                       ///< planar depth where `a` begins to grow; infinite if `a` is 0
  double length = 0;                  ///< world length of the ray inside the mesh; every one of several overlapping
                                      ///< cells counts
  std::size_t segments = 0;
};

/// A pixel of the image; (0, 0) is the top left.
struct PixelIndex {
  int x, y;
  bool operator==(const PixelIndex&) const = default;
};

/// The reference solution with which images are compared, as in Session::verify(): the results of individual rays of
/// one view, computed in double precision by code that shares nothing with the renderers. It is slow, because a ray is
/// tested against every tet or voxel on its path.
class TESSERA_EXPORT Reference {
 public:
  /// Only the emission, the surfaces and the shading of grids are used from the settings. Throws Error(bad_input) for
  /// an invalid view, an empty transfer function, and a mesh that is not whole on this rank.
  Reference(Dataset dataset, const View& view, const TransferFunction& transfer_function,
            const Settings& settings = {});
  ~Reference();
  Reference(const Reference&) = delete;
  Reference& operator=(const Reference&) = delete;

  /// Returns the results of the rays through the centres of the `wanted` pixels, in the same order. If `threads` is 0,
  /// all cores are used.
  [[nodiscard]] std::vector<ReferencePixel> pixels(std::span<const PixelIndex> wanted, int threads = 0) const;

 private:
  struct State;
  std::unique_ptr<const State> state_;
};

/// Returns `count` different random pixels in row-major order; every set of pixels is equally likely. Returns all
/// pixels if the image has at most `count`. The same seed gives the same pixels on every machine.
TESSERA_EXPORT std::vector<PixelIndex> random_pixels(ImageSize size, std::size_t count, std::uint64_t seed);

}  // namespace v0_1
}  // namespace tessera
