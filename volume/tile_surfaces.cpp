#include "volume/tile_surfaces.hpp"

#include <algorithm>
#include <cmath>

namespace tessera::volume {

void TileSurfaces::begin(const RayCrossings& crossings, int x0, int y0, std::uint64_t packets, double least,
                         const TileRays& rays) {
  crossings_.clear();
  std::vector<SurfaceCrossing> found;
  for (std::size_t r = 0; r < TileRays::count; ++r) {
    next_[r] = static_cast<std::uint32_t>(crossings_.size());
    stops_[r] = false;
    const int ray = static_cast<int>(r);
    if (rays.k_in[r] < rays.k_out[r] && (packets >> (ray / TileRays::packet_rays) & 1) != 0) {
      found.clear();
      stops_[r] = crossings.find(x0 + TileRays::pixel_x(ray), y0 + TileRays::pixel_y(ray), least, found);
      for (const SurfaceCrossing& c : found)
        crossings_.push_back(
            {std::clamp((c.z - rays.depth_0[r]) / rays.depth_k[r], rays.k_in[r], rays.k_out[r]), c.light});
    }
    last_[r] = static_cast<std::uint32_t>(crossings_.size());
  }
}

double TileSurfaces::end_of_part(std::size_t ray) const {
  return next_[ray] < last_[ray] ? std::min(end_[ray], crossings_[next_[ray]].k) : end_[ray];
}

void TileSurfaces::begin_parts(TileRays& rays) {
  for (std::size_t r = 0; r < TileRays::count; ++r) {
    end_[r] = rays.to[r];
    if (!(rays.from[r] < end_[r])) continue;
    if (stops_[r] && next_[r] == last_[r]) end_[r] = rays.from[r];
    rays.to[r] = std::max(rays.from[r], end_of_part(r));
  }
}

bool TileSurfaces::next_parts(float least, TileRays& rays) {
  bool any = false;
  for (std::size_t r = 0; r < TileRays::count; ++r) {
    if (!(rays.from[r] < end_[r])) continue;
    for (; next_[r] < last_[r] && crossings_[next_[r]].k <= rays.to[r]; ++next_[r]) {
      const Crossing& c = crossings_[next_[r]];
      const double through = rays.transmittance[r];
      const auto add = [&](float& sum, double part) { sum = static_cast<float>(sum + through * part); };
      add(rays.red[r], c.light.red);
      add(rays.green[r], c.light.green);
      add(rays.blue[r], c.light.blue);
      add(rays.alpha[r], c.light.opacity);
      if (std::isnan(rays.first_k[r])) rays.first_k[r] = c.k;
      rays.transmittance[r] = static_cast<float>(through * (1 - c.light.opacity));
    }
    if ((stops_[r] && next_[r] == last_[r]) || rays.transmittance[r] < least) end_[r] = rays.to[r];
    rays.from[r] = rays.to[r];
    rays.to[r] = end_of_part(r);
    any = any || rays.from[r] < end_[r];
  }
  return any;
}

}  // namespace tessera::volume
