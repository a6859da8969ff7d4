// SPDX-License-Identifier: BSD-3-Clause
// Composites lists of fragments front to back, one list per thread. Sums are double, so that a hundred thousand terms
// of 1e-9 are not lost. The transmittance is the exponential of one sum, because a product would accumulate rounding
// errors.
layout(local_size_x = 64) in;

layout(std430, binding = 0) readonly buffer Fragments { vec4 fragments[]; };
layout(std430, binding = 1) readonly buffer Sorted0 { uvec4 sorted_0[]; };
layout(std430, binding = 2) readonly buffer Sorted1 { uvec4 sorted_1[]; };
layout(std430, binding = 4) readonly buffer Lists { uvec4 lists[]; };  // first element, count, which of the two
struct Light {
  vec4 light;   // red, green, blue, optical depth
  uvec4 first;  // the first element with optical depth; all bits set: none
};
layout(std430, binding = 5) writeonly buffer Lights { Light lights[]; };

layout(location = 0) uniform uint first_list;  // index in `lists`
layout(location = 1) uniform uint list_count;
layout(location = 2) uniform float least_transmittance;  // if less remains, the elements behind are not visible

void main() {
  if (gl_GlobalInvocationID.x >= list_count) return;
  const uvec4 list = lists[first_list + gl_GlobalInvocationID.x];
  double red = 0.0lf, green = 0.0lf, blue = 0.0lf, optical_depth = 0.0lf;
  float transmittance = 1.0;
  uint first = 0xffffffffu;
  for (uint i = list.x; i < list.x + list.y; ++i) {
    const uint element = list.z == 0u ? sorted_0[i].w : sorted_1[i].w;
    const vec4 light = fragments[element];
    red += double(transmittance * light.x);
    green += double(transmittance * light.y);
    blue += double(transmittance * light.z);
    if (light.w > 0.0) {
      if (first == 0xffffffffu) first = element;
      optical_depth += double(light.w);
      transmittance = exp(-float(optical_depth));
      if (transmittance < least_transmittance) break;
    }
  }
  lights[gl_GlobalInvocationID.x] =
      Light(vec4(float(red), float(green), float(blue), float(optical_depth)), uvec4(first, 0u, 0u, 0u));
}
