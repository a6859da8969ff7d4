// SPDX-License-Identifier: BSD-3-Clause
// Computes where light begins in lists whose first visible fragment was rasterized on the device: the host does not
// have the depths of these fragments.
layout(local_size_x = 64) in;

layout(std430, binding = 0) readonly buffer Keys { uvec4 keys[]; };      // one per element
layout(std430, binding = 1) readonly buffer Scalars { vec2 scalars[]; };  // one per element: scalars at front and back
layout(std430, binding = 4) readonly buffer Lists { uvec4 lists[]; };    // as in composite.comp; last: fragments given
struct Light {
  vec4 light;
  uvec4 first;
};
layout(std430, binding = 5) buffer Lights { Light lights[]; };

layout(location = 0) uniform uint first_list;
layout(location = 1) uniform uint list_count;

float extinction(uint interval, float s) {
  return at(half_extinction_slope, interval) * (s - at(base, interval)) + at(half_extinction, interval);
}

// Computes integrals::SegmentIntegrator::first_visible().
float first_visible(float front, float back) {
  if (front == back) return 0.0;
  const bool up = back >= front;
  uint interval = locate(front, up);
  for (float s = front;;) {
    const float knot = at(edge, up ? interval + 1u : interval);
    const float end = up ? min(knot, back) : max(knot, back);
    if (end != s && (extinction(interval, s) > 0.0 || extinction(interval, end) > 0.0)) return (s - front) / (back - front);
    if (end == back) return 0.0;
    s = end;
    interval += up ? 1u : 0xffffffffu;
  }
}

void main() {
  const uint i = gl_GlobalInvocationID.x;
  if (i >= list_count) return;
  const uvec4 list = lists[first_list + i];
  const uint element = lights[i].first.x;
  if (element == 0xffffffffu || element < list.x + list.w) return;
  const vec2 ends = scalars[element];
  lights[i].first = uvec4(0xfffffffeu, keys[element].xy, floatBitsToUint(first_visible(ends.x, ends.y)));
}
