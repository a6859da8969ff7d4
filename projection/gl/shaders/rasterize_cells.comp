// SPDX-License-Identifier: BSD-3-Clause
// Computes ray segments from cells: projection/gl/gl_rasterizer.hpp. Each cell has eight threads, each of which
// processes every eighth pixel of the cell's box.
layout(local_size_x = 64) in;
const uint threads_a_cell = 8u;

struct Cell {
  double corners[16];  // x, y, depth, scalar of each
  uint tet, tet_high;
};
// The input of one dispatch: cells of one job.
struct Part {
  double half_width, half_height, tangents_per_pixel;  // the last is 0 in orthographic views
  double key_origin, keys_per_depth;
  double scalar_origin, scalar_unit, length_unit;
  int x0, y0, x1, y1;  // pixels
  uint first_cell, cell_count, first_pixel, counting;
};
layout(std430, binding = 0) readonly buffer Cells { Cell cells[]; };
layout(std430, binding = 1) buffer Next { uint next[]; };
layout(std430, binding = 2) writeonly buffer Keys { uvec4 keys[]; };
layout(std430, binding = 4) writeonly buffer Values { vec4 values[]; };
layout(std430, binding = 5) writeonly buffer Scalars { vec2 scalars[]; };
layout(std430, binding = 6) readonly buffer Parts { Part parts[]; };

layout(location = 0) uniform uint part_number;

// The two ends of each edge; and for each face, its corners a < b < c and its edges bc, ac, ab.
const ivec2 edge_ends[6] = ivec2[6](ivec2(0, 1), ivec2(0, 2), ivec2(0, 3), ivec2(1, 2), ivec2(1, 3), ivec2(2, 3));
const ivec3 face_corners[4] = ivec3[4](ivec3(0, 1, 2), ivec3(0, 1, 3), ivec3(0, 2, 3), ivec3(1, 2, 3));
const ivec3 face_edges[4] = ivec3[4](ivec3(3, 1, 0), ivec3(4, 2, 0), ivec3(5, 2, 1), ivec3(5, 4, 3));

dvec2 place[4];
double depth[4], scalar[4], inverse_w[4];
Edge edges[6];

// Rounds to a whole number of units within the range of the transfer function's knots, like integrals::lane_scalar();
// outside of that range, the number does not change.
double rounded(double units) {
  return abs(units) < 1073741824.0lf ? floor(units + 0.5lf) : units;
}

// Returns 1 if the ray passes face f from the side from which the corners of the face are in clockwise order, -1 if
// from the other side, 0 if the ray does not pass the face.
int passes(int f) {
  const int bc = edges[face_edges[f].x].side, ac = edges[face_edges[f].y].side, ab = edges[face_edges[f].z].side;
  if (bc == 0 || ac != -bc || ab != bc) return 0;
  return (f & 1) == 0 ? bc : -bc;  // faces 0 and 2 are oriented outward
}

// Returns depth and scalar where the ray passes face f. Computed relative to corner c, so that a face with a constant
// scalar gives exactly that scalar.
dvec2 crossing(int f) {
  const ivec3 corner = face_corners[f], opposite = face_edges[f];
  precise const double a = edges[opposite.x].size * inverse_w[corner.x], b = edges[opposite.y].size * inverse_w[corner.y],
                       c = edges[opposite.z].size * inverse_w[corner.z];
  const dvec2 at_c = dvec2(depth[corner.z], scalar[corner.z]);
  precise const dvec2 from_c = a * (dvec2(depth[corner.x], scalar[corner.x]) - at_c) +
                               b * (dvec2(depth[corner.y], scalar[corner.y]) - at_c);
  precise const dvec2 at_ray = at_c + from_c / (a + b + c);
  return at_ray;
}

uint key_of(double at, Part part) {
  return uint(clamp((at - part.key_origin) * part.keys_per_depth, 0.0lf, 4294967294.0lf));
}

void main() {
  const Part part = parts[part_number];
  const uint number = gl_GlobalInvocationID.x / threads_a_cell;
  if (number >= part.cell_count) return;
  const uint cell = part.first_cell + number;
  dvec2 corners[4];
  for (int i = 0; i < 4; ++i) {
    corners[i] = dvec2(cells[cell].corners[4 * i], cells[cell].corners[4 * i + 1]);
    depth[i] = cells[cell].corners[4 * i + 2];
    scalar[i] = rounded((cells[cell].corners[4 * i + 3] - part.scalar_origin) / part.scalar_unit);
    inverse_w[i] = part.tangents_per_pixel > 0.0lf ? 1.0lf / depth[i] : 1.0lf;
  }
  const dvec2 low = min(min(corners[0], corners[1]), min(corners[2], corners[3]));
  const dvec2 high = max(max(corners[0], corners[1]), max(corners[2], corners[3]));
  const ivec2 first = ivec2(ceil(clamp(low - 0.5lf, dvec2(part.x0, part.y0), dvec2(part.x1, part.y1))));
  const ivec2 end = ivec2(floor(clamp(high + 0.5lf, dvec2(part.x0, part.y0), dvec2(part.x1, part.y1))));
  const ivec2 box = max(end - first, ivec2(0));

  for (uint k = gl_GlobalInvocationID.x % threads_a_cell; k < uint(box.x * box.y); k += threads_a_cell) {
    const ivec2 at = first + ivec2(int(k) % box.x, int(k) / box.x);
    const dvec2 ray = dvec2(at) + 0.5lf;
    for (int i = 0; i < 4; ++i) place[i] = corners[i] - ray;
    uint unsure = 0u;  // one bit per edge
    for (int e = 0; e < 6; ++e) {
      edges[e] = edge(place[edge_ends[e].x], place[edge_ends[e].y]);
      if (edges[e].side == 0) unsure |= 1u << e;
    }
    for (; unsure != 0u; unsure &= unsure - 1u) {  // rare: a loop, so that the code occurs once and not six times
      const int e = findLSB(unsure);
      edges[e] = exact_edge(place[edge_ends[e].x], place[edge_ends[e].y]);
    }
    int plus = -1, minus = -1;
    for (int f = 0; f < 4; ++f) {
      const int way = passes(f);
      if (way > 0) plus = f;
      if (way < 0) minus = f;
    }
    if (plus < 0 || minus < 0) continue;
    const uint pixel = part.first_pixel + uint((at.y - part.y0) * (part.x1 - part.x0) + (at.x - part.x0));
    const uint element = atomicAdd(next[pixel], 1u);
    if (part.counting != 0u) continue;

    const dvec2 one = crossing(plus), other = crossing(minus);
    const bool one_first = one.x <= other.x;
    const dvec2 front = one_first ? one : other, back = one_first ? other : one;
    const dvec2 tangent = (ray - dvec2(part.half_width, part.half_height)) * part.tangents_per_pixel;
    const double slant = sqrt(1.0lf + dot(tangent, tangent));  // length of the ray per unit of depth
    const vec2 ends = vec2(rounded(front.y), rounded(back.y));
    keys[element] = uvec4(key_of(front.x, part), key_of(back.x, part), cells[cell].tet, element);
    values[element] = vec4(float((back.x - front.x) * slant / part.length_unit), ends, -1.0);
    scalars[element] = ends;
  }
}
