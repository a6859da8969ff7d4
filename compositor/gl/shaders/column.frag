// SPDX-License-Identifier: BSD-3-Clause
// Integrates one column of the sorted lists of a scanline, to be blended over the columns behind it (Juliachs et al.
// 2007, 4.3). The integral of a segment is computed as on the CPU. The published loop differs: it uses dx = 1 / Ns
// without the length, and attenuates the colour of each sample by the sample's own whole step.
layout(binding = 0) uniform sampler2D segments;  // {scalar front, scalar back, length, z back}, decreasing z
layout(binding = 1) uniform usampler2D ties;     // {tie, place in the unsorted list}

layout(location = 0) flat in int column;
layout(location = 0) out vec4 light;  // premultiplied colour, and opacity
layout(location = 1) out vec4 first;  // place of the foremost segment with optical depth, counted from 1

layout(location = 0) uniform uint log2_width;
layout(location = 1) uniform uint log2_size;
layout(location = 2) uniform uint first_pixel;  // first pixel of the scanline, whose list begins in row 0

const float null_depth = -3.0e38;

void main() {
  const uint rows = log2_size > log2_width ? 1u << (log2_size - log2_width) : 1u;
  const uint row = (uint(gl_FragCoord.x) - first_pixel) * rows + (uint(column) >> log2_width);
  const ivec2 here = ivec2(uint(column) & ((1u << log2_width) - 1u), row);
  const vec4 segment = texelFetch(segments, here, 0);
  if (segment.w <= null_depth) discard;  // a null element adds nothing
  const vec4 integral = integrate(segment.z, segment.x, segment.y);
  const float opacity = one_minus_exp(integral.w);
  light = vec4(integral.xyz, opacity);
  // Blending replaces the stored place (alpha 1) or keeps it (alpha 0).
  const float visible = integral.w > 0.0 ? 1.0 : 0.0;
  first = vec4(visible * float(texelFetch(ties, here, 0).y + 1u), 0.0, 0.0, visible);
}
