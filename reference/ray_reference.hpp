#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "scene/camera.hpp"

namespace tessera::reference {

/// What a ray sees.
struct Pixel {
  double r = 0, g = 0, b = 0, a = 0;  ///< linear RGB premultiplied by a; a = 1 - transmittance
  double z = 0;                       ///< planar depth where a begins to grow; infinite if a is 0
  double length = 0;                  ///< world length of the ray inside the mesh (overlapping cells count each)
  std::size_t segments = 0;
};

/// A pixel of the image; (0, 0) is the top left.
struct PixelIndex {
  int x, y;
  bool operator==(const PixelIndex&) const = default;
};

/// A truth that pictures are judged against: what a ray through any place of the picture sees, in double precision.
class RayReference {
 public:
  virtual ~RayReference() = default;

  /// The ray through pixel coordinates (x, y); pixel (i, j) has its centre at (i + 0.5, j + 0.5). From any thread.
  [[nodiscard]] virtual Pixel pixel(double x, double y) const = 0;

  /// The rays through the centres of `wanted`, in that order. `threads` 0: all cores.
  [[nodiscard]] virtual std::vector<Pixel> pixels(std::span<const PixelIndex> wanted, int threads = 0) const = 0;

  [[nodiscard]] virtual scene::ImageSize size() const = 0;

 protected:
  RayReference() = default;
  RayReference(const RayReference&) = default;
  RayReference& operator=(const RayReference&) = default;
};

/// All pixels of an image, row-major.
std::vector<PixelIndex> all_pixels(scene::ImageSize size);

/// `count` different pixels, each set equally likely, row-major; all of them if there are no more. The same seed gives
/// the same pixels everywhere.
std::vector<PixelIndex> random_pixels(scene::ImageSize size, std::size_t count, std::uint64_t seed);

}  // namespace tessera::reference
