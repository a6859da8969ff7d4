// SPDX-License-Identifier: BSD-3-Clause
// One pass of bitonic sort over lists in a texture (Kipfer, Segal, Westermann, "UberFlow: A GPU-Based Particle Engine",
// 2004; Juliachs et al. 2007, 4.3): every fragment reads the element at its position and the partner of this element,
// and keeps the one that belongs there. A list of 2^log2_size elements takes one row, or several rows if it is longer
// than a row of the texture: phases up to the length of a row then sort the list in parts, and later phases merge
// these.
layout(binding = 0) uniform sampler2D segments;  // {scalar front, scalar back, length, z back}
layout(binding = 1) uniform usampler2D ties;     // {tie, place in the unsorted list}

layout(location = 0) out vec4 segment;
layout(location = 1) out uvec2 tie;

layout(location = 0) uniform uint log2_width;
layout(location = 1) uniform uint log2_size;
layout(location = 2) uniform uint phase;
layout(location = 3) uniform uint step_in_phase;  // from `phase` down to 0

// Decreasing distance. The paper does not define the order of segments with equal z_back; here it is that of `tie`.
bool farther(vec4 a, uvec2 a_tie, vec4 b, uvec2 b_tie) {
  if (a.w != b.w) return a.w > b.w;
  if (a_tie.x != b_tie.x) return a_tie.x > b_tie.x;
  return a_tie.y > b_tie.y;
}

void main() {
  const ivec2 here = ivec2(gl_FragCoord.xy);
  const uint rows = log2_size > log2_width ? 1u << (log2_size - log2_width) : 1u;
  const uint row_in_list = uint(here.y) & (rows - 1u), first_row = uint(here.y) - row_in_list;
  const uint element = (row_in_list << log2_width) + uint(here.x), distance = 1u << step_in_phase;
  const uint partner = element ^ distance;
  const ivec2 there = ivec2(partner & ((1u << log2_width) - 1u), first_row + (partner >> log2_width));

  segment = texelFetch(segments, here, 0);
  tie = texelFetch(ties, here, 0).xy;
  const vec4 other = texelFetch(segments, there, 0);
  const uvec2 other_tie = texelFetch(ties, there, 0).xy;
  const bool is_low = (element & distance) == 0u, decreasing = ((element >> (phase + 1u)) & 1u) == 0u;
  // Equal elements (null elements) are not exchanged on either side, so that none is lost.
  const bool swap = is_low == decreasing ? farther(other, other_tie, segment, tie) : farther(segment, tie, other, other_tie);
  if (swap) {
    segment = other;
    tie = other_tie;
  }
}
