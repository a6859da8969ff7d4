// SPDX-License-Identifier: BSD-3-Clause
// Moves fragments that were given to their places in lists, which have space for the fragments that the device
// rasterizes.
layout(local_size_x = 256) in;

layout(std430, binding = 0) readonly buffer GivenKeys { uvec4 given_keys[]; };  // {front, back, tie, place}
layout(std430, binding = 1) readonly buffer GivenValues { vec4 given_values[]; };
layout(std430, binding = 2) writeonly buffer Keys { uvec4 keys[]; };
layout(std430, binding = 4) writeonly buffer Values { vec4 values[]; };

layout(location = 0) uniform uint given_count;

void main() {
  const uint i = gl_GlobalInvocationID.x;
  if (i >= given_count) return;
  const uvec4 key = given_keys[i];
  keys[key.w] = key;
  values[key.w] = given_values[i];
}
