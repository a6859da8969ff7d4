// SPDX-License-Identifier: BSD-3-Clause
// Replaces every ray segment by its light, in place: {length, scalar front, scalar back, -1} becomes {red, green, blue,
// optical depth}. Runs of segments are light already: their fourth number is not negative.
layout(local_size_x = 256) in;

layout(std430, binding = 0) buffer Fragments { vec4 fragments[]; };
layout(location = 0) uniform uint fragment_count;

void main() {
  const uint i = gl_GlobalInvocationID.x;
  if (i >= fragment_count) return;
  const vec4 f = fragments[i];
  if (f.w < 0.0) fragments[i] = integrate(f.x, f.y, f.z);
}
