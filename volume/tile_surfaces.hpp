#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "volume/ray_crossings.hpp"
#include "volume/tile_rays.hpp"

namespace tessera::volume {

/// The surfaces that a tile's rays of one axis code cross, and how far they have come among them. Kernels know nothing
/// of surfaces: they take rays through what lies before the next one, then it is put behind what a ray has gathered,
/// and so on. As rays may begin and end anywhere in a voxel, the light between surfaces is as exact as any.
class TileSurfaces {
 public:
  /// Finds the crossings of the rays in `packets`, a bit each, of the tile whose first pixel is (x0, y0). Surfaces end
  /// a ray where they alone let less than `least` through.
  void begin(const RayCrossings& crossings, int x0, int y0, std::uint64_t packets, double least, const TileRays& rays);

  /// Of the parts of rays from TileRays::from to `to` it leaves what comes before each one's next surface.
  void begin_parts(TileRays& rays);
  /// Puts the surfaces at `to` behind those parts and goes on to what comes before the next ones. False if no ray that
  /// lets `least` through has any.
  bool next_parts(float least, TileRays& rays);

 private:
  struct Crossing {
    double k;
    scene::SurfaceSet::Light light;
  };
  [[nodiscard]] double end_of_part(std::size_t ray) const;

  std::vector<Crossing> crossings_;                         ///< ray by ray
  std::array<std::uint32_t, TileRays::count> next_, last_;  ///< of each ray: in `crossings_`
  std::array<bool, TileRays::count> stops_;                 ///< whether it ends at its last surface
  std::array<double, TileRays::count> end_;                 ///< of what is to be cast now
};

}  // namespace tessera::volume
