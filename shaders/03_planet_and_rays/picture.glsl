// What chapter 03 paints: a ground whose pattern shows every lost digit, a hint of air, and colour scales for the debug
// views. Colours are display values, 0 … 1. Lengths in km.
#ifndef WELKIN_PLANET_PICTURE_GLSL
#define WELKIN_PLANET_PICTURE_GLSL

// Angle of a right triangle with sides a (opposite) and b, |result| <= pi: drivers' atan errs by 3e-6 rad, 18 m on the
// ground, so small angles use the series.
float precise_angle(float a, float b) {
  float q = b > 0.0 ? a / b : 2.0;
  if (abs(q) < 0.1) return q * (1.0 - q * q * (1.0 / 3.0 - q * q * 0.2));
  return atan(a, b > 0.0 ? b : min(b, -1.0e-20));  // atan(0, 0) is undefined
}

// Arc lengths on the ground from the point below the camera, east and north, of a point given relative to that point.
vec2 ground_arcs(float ground_radius_km, vec3 from_foot_km) {
  float z = ground_radius_km + from_foot_km.z;
  return ground_radius_km * vec2(precise_angle(from_foot_km.x, z),
                                 precise_angle(from_foot_km.y, length(vec2(from_foot_km.x, z))));
}

float checker(vec2 place_km, float cell_km) {
  vec2 cell = floor(place_km / cell_km);
  return mod(cell.x + cell.y, 2.0);
}

// 0 … 1: checkerboards whose cells are powers of ten from 1 cm to 1000 km and stay wider than `footprint_km`. Three are
// added, so that the finest can fade out and the coarsest fade in before the next power of ten takes over.
float ground_pattern(vec2 place_km, float footprint_km) {
  float level = clamp(log2(max(8.0 * footprint_km, 1.0e-9)) * 0.30103, -6.0, 1.999);
  float cell_km = pow(10.0, floor(level) + 1.0);
  float fade = smoothstep(0.4, 1.0, level - floor(level));
  return 0.5 + 0.4 * (checker(place_km, cell_km) - 0.5) * (1.0 - fade) +
         0.4 * (checker(place_km, 10.0 * cell_km) - 0.5) +
         0.4 * (checker(place_km, 100.0 * cell_km) - 0.5) * fade;
}

// Dark violet, blue, teal, green, yellow, red for x = 0, 0.2, … 1; clamped outside.
vec3 scale_colour(float x) {
  const vec3 nodes[6] = vec3[](vec3(0.16, 0.03, 0.30), vec3(0.14, 0.29, 0.72), vec3(0.05, 0.62, 0.64),
                               vec3(0.42, 0.80, 0.25), vec3(0.98, 0.86, 0.20), vec3(0.80, 0.10, 0.08));
  float place = clamp(x, 0.0, 1.0) * 5.0;
  int first = min(int(place), 4);
  return mix(nodes[first], nodes[first + 1], place - float(first));
}

// White at 0; red above and blue below it, full at ±1.
vec3 signed_colour(float x) {
  vec3 full = x >= 0.0 ? vec3(0.78, 0.05, 0.10) : vec3(0.05, 0.20, 0.75);
  return mix(vec3(0.97), full, clamp(abs(x), 0.0, 1.0));
}

// Where a length stands on a logarithmic scale that begins at `first_km` and has `decades` powers of ten: 0 … 1.
float on_log_scale(float length_km, float first_km, float decades) {
  return clamp(log2(max(length_km, 1.0e-12) / first_km) * 0.30103 / decades, 0.0, 1.0);
}

#endif
