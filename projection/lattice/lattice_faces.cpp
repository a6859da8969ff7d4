// SPDX-License-Identifier: BSD-3-Clause
#include "projection/lattice/lattice_faces.hpp"

#include <algorithm>

#include "projection/surface_crossings.hpp"

namespace tessera::projection {

void LatticeFaces::set(const FaceMarks& marks, const scene::Lattice& lattice, std::span<const Step> steps) {
  begin_.assign(marks.begin().begin(), marks.begin().end());
  place_.clear(), own_.clear();
  float before = 0;
  for (const FaceMark& mark : marks.marks()) {
    const bool first = static_cast<std::int32_t>(place_.size()) == begin_[mark.pixel];
    const float crossing = LatticeMark::of({mark.number, mark.cosine});
    const std::int32_t at = lattice.depth_step(mark.depth);
    place_.push_back(first ? at : std::max(at, place_.back() + (crossing < before ? 1 : 0)));
    before = crossing;
    if (mark.own)
      own_.push_back({static_cast<std::int32_t>(mark.pixel), place_.back(), crossing,
                      lattice_scalars(mark.value, mark.value, steps, lattice).back});
  }
}

void LatticeFaces::append_own(SegmentStream& out) const {
  out.reserve(out.size + own_.size());
  for (const Own& own : own_) {
    const std::size_t i = out.size++;
    out.pixel[i] = own.pixel;
    out.front[i] = out.back[i] = own.place;
    out.scalar_front[i] = own.mark, out.scalar_back[i] = own.scalar;
    if (out.lit) out.own[i] = SegmentLight().own, out.white[i] = SegmentLight().white;
  }
}

}  // namespace tessera::projection
