// SPDX-License-Identifier: BSD-3-Clause
// The order of keys {front, back, tie, element} by depth. Because of the last member, the order is total.
bool before(uvec4 a, uvec4 b) {
  if (a.x != b.x) return a.x < b.x;
  if (a.y != b.y) return a.y < b.y;
  if (a.z != b.z) return a.z < b.z;
  return a.w < b.w;
}
