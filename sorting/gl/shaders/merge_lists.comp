// SPDX-License-Identifier: BSD-3-Clause
// One pass over long lists: neighbouring sorted parts become one. Every element finds its place by itself: its own number
// in its part and the number of elements before it in the other (a binary search).
layout(local_size_x = 256) in;

layout(std430, binding = 0) readonly buffer From { uvec4 from[]; };
layout(std430, binding = 1) writeonly buffer To { uvec4 to[]; };
// A workgroup each: where the two parts begin, how long they are (the second may be empty), and which 256 elements of
// them are this workgroup's.
layout(std430, binding = 2) readonly buffer Merges { uvec4 merges[]; };

layout(location = 0) uniform uint first_merge;

void main() {
  const uvec4 merge = merges[first_merge + gl_WorkGroupID.x];
  const uint left = merge.x, right = merge.x + merge.y, end = right + merge.z;
  const uint at = merge.x + merge.w + gl_LocalInvocationID.x;
  if (at >= end) return;
  const uvec4 key = from[at];
  const bool in_left = at < right;
  const uint other = in_left ? right : left;
  uint low = other, high = in_left ? end : right;
  while (low < high) {
    const uint middle = (low + high) / 2u;
    if (before(from[middle], key))
      low = middle + 1u;
    else
      high = middle;
  }
  to[left + (at - (in_left ? left : right)) + (low - other)] = key;
}
