// SPDX-License-Identifier: BSD-3-Clause
// Bitonic sort of short lists, or of pieces of long lists, in shared memory. The 1024 slots of a workgroup contain
// 1024 / 2^n lists of up to 2^n elements. All lists of a dispatch need the same n, so that no list is padded beyond the
// next power of two, and none takes more steps than its length requires.
layout(local_size_x = 256) in;

layout(std430, binding = 0) readonly buffer Unsorted { uvec4 unsorted[]; };
layout(std430, binding = 1) writeonly buffer Sorted { uvec4 sorted[]; };
layout(std430, binding = 2) readonly buffer Pieces { uvec2 pieces[]; };  // first element, number of elements

layout(location = 0) uniform uint first_piece;
layout(location = 1) uniform uint piece_count;
layout(location = 2) uniform uint log2_size;

const uint slot_count = 1024u;
shared uvec4 slots[slot_count];

void main() {
  const uint size = 1u << log2_size;
  const uint piece_0 = gl_WorkGroupID.x * (slot_count >> log2_size);
  for (uint slot = gl_LocalInvocationID.x; slot < slot_count; slot += gl_WorkGroupSize.x) {
    const uint piece = piece_0 + (slot >> log2_size), element = slot & (size - 1u);
    uvec4 key = uvec4(0xffffffffu);  // behind everything
    if (piece < piece_count) {
      const uvec2 range = pieces[first_piece + piece];
      if (element < range.y) key = unsorted[range.x + element];
    }
    slots[slot] = key;
  }
  for (uint phase = 1u; phase <= log2_size; ++phase) {
    for (uint distance = 1u << (phase - 1u); distance > 0u; distance >>= 1) {
      barrier();
      for (uint pair = gl_LocalInvocationID.x; pair < slot_count / 2u; pair += gl_WorkGroupSize.x) {
        const uint low = 2u * pair - (pair & (distance - 1u)), high = low + distance;
        // The last phase is ascending in every list.
        const bool ascending = (low & (1u << phase) & (size - 1u)) == 0u;
        const uvec4 a = slots[low], b = slots[high];
        if (before(b, a) == ascending) {
          slots[low] = b;
          slots[high] = a;
        }
      }
    }
  }
  barrier();
  for (uint slot = gl_LocalInvocationID.x; slot < slot_count; slot += gl_WorkGroupSize.x) {
    const uint piece = piece_0 + (slot >> log2_size), element = slot & (size - 1u);
    if (piece >= piece_count) continue;
    const uvec2 range = pieces[first_piece + piece];
    if (element < range.y) sorted[range.x + element] = slots[slot];
  }
}
