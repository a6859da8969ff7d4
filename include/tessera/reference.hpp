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
  double z = 0;                       ///< planar depth where a begins to grow; infinite if a is 0
  double length = 0;                  ///< world length of the ray inside the mesh (overlapping cells each count)
  std::size_t segments = 0;
};

/// A pixel of the image; (0, 0) is the top left.
struct PixelIndex {
  int x, y;
  bool operator==(const PixelIndex&) const = default;
};

/// The reference solution that images are compared with, as in Session::verify(): the result of individual rays of one
/// view, in double precision and by code that shares nothing with the renderers. Slow: a ray is tested against every
/// tet or voxel on its path.
class TESSERA_EXPORT Reference {
 public:
  /// Only the emission, the surfaces and a grid's shading of the settings count. Throws Error(bad_input) for an invalid
  /// view, an empty transfer function, or a mesh that is not whole on this rank.
  Reference(Dataset dataset, const View& view, const TransferFunction& transfer_function,
            const Settings& settings = {});
  ~Reference();
  Reference(const Reference&) = delete;
  Reference& operator=(const Reference&) = delete;

  /// The rays through the centres of `wanted`, in that order. `threads` 0: all cores.
  [[nodiscard]] std::vector<ReferencePixel> pixels(std::span<const PixelIndex> wanted, int threads = 0) const;

 private:
  struct State;
  std::unique_ptr<const State> state_;
};

/// `count` different pixels, row-major, where every set is equally likely; all pixels if `count` is not smaller. The
/// same seed gives the same pixels everywhere.
TESSERA_EXPORT std::vector<PixelIndex> random_pixels(ImageSize size, std::size_t count, std::uint64_t seed);

}  // namespace v0_1
}  // namespace tessera
