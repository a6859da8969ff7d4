// SPDX-License-Identifier: BSD-3-Clause
// The integral of one ray segment, in float. integrals/integrate_lanes-inl.h (exact) and
// integrals/integrate_sampled.cpp explain the methods. Light is {red, green, blue, optical depth}, premultiplied,
// without the attenuation by matter in front of the segment.

// The numbers of a LaneTable, in columns of `stride` numbers.
layout(std430, binding = 3) readonly buffer Table { float table[]; };
layout(location = 10) uniform uint stride;
layout(location = 11) uniform uint knot_count;
layout(location = 12) uniform uint independent;
layout(location = 13) uniform uint samples;  // number of samples; 0: exact integration

const uint edge = 0u, base = 1u, half_extinction = 2u, half_extinction_slope = 3u, red = 4u, green = 6u, blue = 8u;

float at(uint column, uint interval) { return table[column * stride + interval]; }

// Returns the interval between knots in which a ray at scalar s continues. If s is a knot, this is the interval above
// the knot if the scalar increases or is constant, otherwise the one below.
uint locate(float s, bool up) {
  uint low = 0u, high = knot_count;  // bounds of the number of knots passed
  while (low < high) {
    const uint middle = (low + high) / 2u;
    const float knot = at(edge, middle + 1u);
    if (knot < s || (up && knot == s))
      low = middle + 1u;
    else
      high = middle;
  }
  return low;
}

const float opaque_depth = 20.0, most_depth = 1e15, most_length = 1e18, step_depth = 1.0, transmittance_left = 2e-9;

struct Stretch {
  float depth_front, depth_back, from, span, length;
};

struct StretchLight {
  float alpha, weight, moment;
};

StretchLight stretch_light(Stretch s) {
  const float h = s.depth_front + s.depth_back, b = s.depth_back - s.depth_front, h2 = h * h;
  const float e_1 = 0.499999999312 +
                    h * (-0.124999951852 +
                         h * (0.0208327801554 +
                              h * (-0.0026018185097 + h * (0.000255856557986 + h * -1.7525919055e-5))));
  const float fade = h * e_1, through_half = 1.0 - fade;
  const float g_b = 0.166666680449 +
                    b * (0.0166684718002 + b * (0.00119048719931 + b * (6.6856007248e-5 + b * 2.70946476007e-6)));
  const float g_bh2 =
      0.0416657135187 + b * (0.00416650894235 + b * (0.000289663022651 + b * 1.69362711045e-5));
  const float g_bh4 = 0.000524696885061 + b * (3.75043097578e-5 + b * 8.73138877496e-6);
  const float g = h2 * (h2 * g_bh4 + g_bh2) + b * g_b;
  StretchLight light;
  light.alpha = fade * (2.0 - fade);
  if (independent != 0u) {
    const float mean = through_half * g + through_half;
    const float o_b =
        0.0833333531774 + b * (0.00833212200079 + b * (0.000595357896661 + b * 3.3527899865e-5));
    const float o_bh2 = 0.00208316965904 + b * (0.00015103357027 + b * 9.71280246795e-6);
    const float o = h2 * (h2 * 1.864437097e-5 + o_bh2) + o_b;
    const float first = through_half * (0.5 * g + (0.5 - h * o));
    light.weight = s.length * mean;
    light.moment = s.length * s.span * first + s.from * light.weight;
    return light;
  }
  light.weight = light.alpha;
  light.moment = s.span * (through_half * (g + fade)) + s.from * light.alpha;
  return light;
}

vec4 integrate_exact(float length, float front, float back) {
  // Rounding errors of long sums in float accumulate, so sums of sixteen pieces are added to the total.
  float transmittance = 1.0, since_transmittance = 1.0, depth_sum = 0.0, since_depth = 0.0;
  vec3 color = vec3(0.0), since_color = vec3(0.0);
  if (!(length > 0.0)) return vec4(0.0);
  length = min(length, most_length);
  const bool up = back >= front;
  uint interval = locate(front, up);
  float scalar = front;
  const float length_per_scalar = front == back ? 0.0 : length / (back - front);
  for (uint pieces = 1u;; ++pieces) {
    const float knot = at(edge, up ? interval + 1u : interval);
    const float end = up ? min(knot, back) : max(knot, back);
    const bool whole = end == back && scalar == front;
    const float piece = whole ? length : (end - scalar) * length_per_scalar;
    const float start = at(half_extinction, interval), slope = at(half_extinction_slope, interval);
    const float from = scalar - at(base, interval), to = end - at(base, interval);
    Stretch s = Stretch((slope * from + start) * piece, (slope * to + start) * piece, from, end - scalar, piece);
    const float depth = s.depth_front + s.depth_back;
    float weight = 0.0, moment = 0.0, t = since_transmittance;
    if (depth > step_depth) {
      // Steps of one unit of optical depth, until at most one unit remains or the remainder is not visible.
      s.depth_front = min(s.depth_front, most_depth);
      s.depth_back = min(s.depth_back, most_depth);
      while (s.depth_front + s.depth_back > step_depth && t * transmittance >= transmittance_left) {
        const float rise = s.depth_back - s.depth_front;
        const float root = sqrt(max(0.0, s.depth_front * s.depth_front + step_depth * rise));
        const float u = min(1.0, step_depth / (s.depth_front + root)), left = 1.0 - u;
        const float depth_cut = rise * u + s.depth_front;
        const Stretch first = Stretch(s.depth_front * u, depth_cut * u, s.from, s.span * u, s.length * u);
        const StretchLight light = stretch_light(first);
        weight += t * light.weight;
        moment += t * light.moment;
        t -= t * light.alpha;
        s = Stretch(depth_cut * left, s.depth_back * left, s.from + first.span, s.span * left, s.length * left);
      }
      if (t * transmittance < transmittance_left) s = Stretch(0.0, 0.0, s.from, s.span, 0.0);
    }
    const StretchLight light = stretch_light(s);
    weight += t * light.weight;
    moment += t * light.moment;
    since_transmittance = t - t * light.alpha;
    since_depth += depth;
    since_color += vec3(at(red, interval), at(green, interval), at(blue, interval)) * weight +
                   vec3(at(red + 1u, interval), at(green + 1u, interval), at(blue + 1u, interval)) * moment;
    const bool done = end == back || depth_sum + since_depth >= opaque_depth;
    if (done || pieces % 16u == 0u) {
      color += transmittance * since_color;
      transmittance *= since_transmittance;
      depth_sum += since_depth;
      since_color = vec3(0.0);
      since_transmittance = 1.0;
      since_depth = 0.0;
    }
    if (done) break;
    scalar = end;
    interval += up ? 1u : 0xffffffffu;
  }
  return vec4(color, depth_sum);
}

// Returns 1 - exp(-x) for x >= 0, without cancellation for small x.
float one_minus_exp(float x) {
  if (x > 0.3) return 1.0 - exp(-x);
  return x * (1.0 - x * (0.5 - x * (1.0 / 6.0 - x * (1.0 / 24.0 - x * (1.0 / 120.0 - x * (1.0 / 720.0))))));
}

// `sampled:Ns` (Juliachs et al. 2007, 4.3): Ns samples at the middles of Ns steps. The paper has dx = 1 / Ns, but also
// states that null elements, of length 0, do not contribute, which requires dx = length / Ns.
vec4 integrate_sampled(float length, float front, float back) {
  const float dx = length / float(samples), change = back - front;
  vec3 color = vec3(0.0);
  float transmittance = 1.0, optical_depth = 0.0;
  for (uint sample_number = 0u; sample_number < samples; ++sample_number) {
    const float s = change * ((float(sample_number) + 0.5) / float(samples)) + front;
    const uint interval = locate(s, true);
    const float from = s - at(base, interval);
    const float depth = 2.0 * (at(half_extinction_slope, interval) * from + at(half_extinction, interval)) * dx;
    const float absorbed = one_minus_exp(depth);
    const float source = independent == 0u ? absorbed : depth > 1e-8 ? dx * (absorbed / depth) : dx;
    const vec3 c = vec3(at(red, interval), at(green, interval), at(blue, interval)) +
                   from * vec3(at(red + 1u, interval), at(green + 1u, interval), at(blue + 1u, interval));
    color += transmittance * source * c;
    transmittance -= transmittance * absorbed;
    optical_depth += depth;
  }
  return vec4(color, optical_depth);
}

vec4 integrate(float length, float front, float back) {
  return samples > 0u ? integrate_sampled(length, front, back) : integrate_exact(length, front, back);
}
