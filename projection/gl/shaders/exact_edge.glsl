// SPDX-License-Identifier: BSD-3-Clause
// Decides exactly on which side of the edge a -> b a ray passes: projection/edge_sign.hpp. The positions of corners are
// those of the tie rule, multiples of 2^-32 pixel, less than 2^18 pixels from the ray: their differences are exact in
// doubles.

struct Edge {
  double size;  // |E|, where E = a x b for corners relative to the ray
  int side;     // sign of E, or if E is zero, by the tie rule; 0: the edge is a point
};

// Returns |v| in units of 2^-32: the low half, then the high half.
uvec2 whole(double v) {
  const double size = abs(v), pixels = floor(size);
  return uvec2(uint((size - pixels) * 4294967296.0lf), uint(pixels));
}

// Returns the product, 128 bits, the lowest first.
uvec4 product(uvec2 a, uvec2 b) {
  uint low_0, low_1, low_2, low_3, high_0, high_1, high_2, high_3, carry_0, carry_1, carry_2, carry_3, carry_4;
  umulExtended(a.x, b.x, high_0, low_0);
  umulExtended(a.x, b.y, high_1, low_1);
  umulExtended(a.y, b.x, high_2, low_2);
  umulExtended(a.y, b.y, high_3, low_3);
  uint second = uaddCarry(high_0, low_1, carry_0);
  second = uaddCarry(second, low_2, carry_1);
  uint third = uaddCarry(low_3, high_1, carry_2);
  third = uaddCarry(third, high_2, carry_3);
  third = uaddCarry(third, carry_0 + carry_1, carry_4);
  return uvec4(low_0, second, third, high_3 + carry_2 + carry_3 + carry_4);
}

uvec4 sum(uvec4 a, uvec4 b) {
  uint carry_0, carry_1, carry_2, more_1, more_2;
  uvec4 s;
  s.x = uaddCarry(a.x, b.x, carry_0);
  s.y = uaddCarry(uaddCarry(a.y, b.y, carry_1), carry_0, more_1);
  s.z = uaddCarry(uaddCarry(a.z, b.z, carry_2), carry_1 + more_1, more_2);
  s.w = a.w + b.w + carry_2 + more_2;
  return s;
}

// Returns a - b, for a >= b.
uvec4 difference(uvec4 a, uvec4 b) {
  uint borrow_0, borrow_1, borrow_2, more_1, more_2;
  uvec4 d;
  d.x = usubBorrow(a.x, b.x, borrow_0);
  d.y = usubBorrow(usubBorrow(a.y, b.y, borrow_1), borrow_0, more_1);
  d.z = usubBorrow(usubBorrow(a.z, b.z, borrow_2), borrow_1 + more_1, more_2);
  d.w = a.w - b.w - borrow_2 - more_2;
  return d;
}

bool less(uvec4 a, uvec4 b) {
  if (a.w != b.w) return a.w < b.w;
  if (a.z != b.z) return a.z < b.z;
  if (a.y != b.y) return a.y < b.y;
  return a.x < b.x;
}

Edge exact_edge(dvec2 a, dvec2 b) {
  const uvec4 p = product(whole(a.x), whole(b.y)), q = product(whole(b.x), whole(a.y));
  const int p_sign = int(sign(a.x)) * int(sign(b.y)), q_sign = -int(sign(b.x)) * int(sign(a.y));
  uvec4 e;
  int side;
  if (p_sign == 0 || q_sign == 0 || p_sign == q_sign) {  // a product of a zero is zero
    e = sum(p, q);
    side = p_sign != 0 ? p_sign : q_sign;
  } else if (less(p, q)) {
    e = difference(q, p);
    side = q_sign;
  } else {
    e = difference(p, q);
    side = p_sign;
  }
  if (e == uvec4(0u)) {  // the ray meets the edge, and is shifted by (s, s^2) for an infinitely small s
    const double along_x = a.y - b.y, along_y = b.x - a.x;
    side = int(along_x != 0.0lf ? sign(along_x) : sign(along_y));
  }
  const double scale = 4294967296.0lf;
  const double size = ((double(e.w) * scale + double(e.z)) * scale + double(e.y)) * scale + double(e.x);
  return Edge(size / (scale * scale), side);
}

// Computes the edge in double; the side is 0 if rounding may have changed the sign.
Edge edge(dvec2 a, dvec2 b) {
  const double p = a.x * b.y, q = b.x * a.y, e = p - q;
  // The bound is twice the error of up to three roundings of 2^-53 each. If both products are rounded, they keep their
  // order, and only a result of zero is uncertain; if the compiler fuses one of them with the difference, any result
  // below the bound may have the wrong sign.
  const bool certain = abs(e) > 4.5e-16lf * (abs(p) + abs(q));
  return Edge(abs(e), certain ? (e > 0.0lf ? 1 : -1) : 0);
}
