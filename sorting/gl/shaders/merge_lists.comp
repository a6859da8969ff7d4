// SPDX-License-Identifier: BSD-3-Clause
// One pass over long lists, which merges pairs of neighbouring sorted parts. The place of every element is computed
// independently: the sum of its index in its own part and the number of elements of the other part that precede it,
// which a binary search finds.
layout(local_size_x = 256) in;

layout(std430, binding = 0) readonly buffer From { uvec4 from[]; };
layout(std430, binding = 1) writeonly buffer To { uvec4 to[]; };
// One entry per workgroup: where the two parts begin, their lengths (the second may be empty), and which 256 of their
// elements the workgroup processes.
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
