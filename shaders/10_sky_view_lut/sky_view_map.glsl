// The sky view table's map: directions seen from one altitude, against the sun's azimuth and the horizon. Pure functions,
// also valid C++; lengths in km.
//
//   across   x = sin(phi/2)                   phi: azimuth from the sun's, 0 … pi (the sky is the same on both sides)
//   up       s = sqrt(n)                      n = tan(l/2) / tan(l_max/2), l: angle from the horizon, upwards to the zenith
//   down     s = sqrt(n (1 + k) / (n + k))    or downwards to the nadir; k = m + sqrt(m), m = tan(dip/2)
//
// Half angles need no inverse trigonometry: every one of them is a quotient of numbers known from the vectors, and both
// directions of the map are algebra. The root crowds rows at the horizon, where the sky changes fastest. Downwards a ray's
// length falls to a few tenths within a dip, 0.02 degrees for eyes half a metre up, and k crowds the rows within a few of these.
// Sky and ground are two halves of the table, each with its own rows, and no look-up mixes them: the horizon stays a line.
#ifndef WELKIN_SKY_VIEW_MAP_GLSL
#define WELKIN_SKY_VIEW_MAP_GLSL

#include "03_planet_and_rays/ray_sphere.glsl"

// Where in the table a direction is: x and s in 0 … 1 and which half.
struct SkyViewPlace {
  float across;
  float from_horizon;
  bool below;
};

// [horizon]
// tan(l/2) of the zenith (above) and of the nadir (below), l from the horizon. Neither form subtracts: cosine <= 0.
float half_angle_range(vec2 horizon, bool below) {
  return below ? horizon.y / (1.0 - horizon.x) : (1.0 - horizon.x) / horizon.y;
}

// k of the rows below the horizon. Its floor is for an eye on the ground, whose rays down have no length.
float rows_below_knee(vec2 horizon) {
  float m = max(-horizon.x / (1.0 + horizon.y), 1.0e-6);
  return m + sqrt(m);
}
// [/horizon]

// [place]
// view, sun: unit vectors in the local frame, z up. sin(phi/2) is half the distance between the two horizontal unit
// vectors; one that is vertical has no azimuth and gets the sun's.
SkyViewPlace sky_view_place(vec2 horizon, vec3 view, vec3 sun) {
  float sine = sqrt(view.x * view.x + view.y * view.y);
  float sun_sine = sqrt(sun.x * sun.x + sun.y * sun.y);
  SkyViewPlace place;
  place.across = 0.0;
  if (sine > 0.0 && sun_sine > 0.0) {
    float x = view.x / sine - sun.x / sun_sine;
    float y = view.y / sine - sun.y / sun_sine;
    place.across = min(0.5 * sqrt(x * x + y * y), 1.0);
  }
  // Sine and cosine of the angle from the horizon: those of a difference of zenith angles.
  float s = horizon.y * view.z - horizon.x * sine;
  float c = horizon.x * view.z + horizon.y * sine;
  place.below = s < 0.0;
  float t = abs(s) / max(1.0 + c, 1.0e-20);
  float n = min(t / half_angle_range(horizon, place.below), 1.0);
  float knee = rows_below_knee(horizon);
  place.from_horizon = sqrt(place.below ? n * (1.0 + knee) / (n + knee) : n);
  return place;
}

// The inverse: (cosine of the zenith angle, its sine) of a row, and (cosine, sine) of the azimuth of a column.
// The row at the horizon itself is moved off it, so that it is on its side of it in every rounding: above by 2e-6 rad, below
// by a hundred-thousandth of the dip or 8e-8 rad, whichever is less: a ray's length changes by 0.5 % there.
vec2 sky_view_zenith(vec2 horizon, float from_horizon, bool below) {
  float s2 = from_horizon * from_horizon;
  float knee = rows_below_knee(horizon);
  float range = half_angle_range(horizon, below);
  float t = below ? max(knee * s2 / (1.0 + knee - s2) * range, min(1.0e-5 * knee * knee, 4.0e-8)) : max(s2, 1.0e-6) * range;
  float c = (1.0 - t * t) / (1.0 + t * t);
  float s = (below ? -2.0 : 2.0) * t / (1.0 + t * t);
  return vec2(clamp(horizon.x * c + horizon.y * s, -1.0, 1.0), max(horizon.y * c - horizon.x * s, 0.0));
}

vec2 sky_view_azimuth(float across) {
  return vec2(1.0 - 2.0 * across * across, 2.0 * across * sqrt(max((1.0 - across) * (1.0 + across), 0.0)));
}
// [/place]

// [texels]
// A place to texture coordinates of a table of size (w, h), h even, and a texel's centre to its place: exact inverses.
// Rows run from the zenith down to the horizon, then from the horizon down to the nadir.
vec2 sky_view_uv(SkyViewPlace place, ivec2 size) {
  float half_rows = float(size.y / 2);
  float row = place.below ? half_rows + place.from_horizon * (half_rows - 1.0) : (1.0 - place.from_horizon) * (half_rows - 1.0);
  return vec2((0.5 + place.across * float(size.x - 1)) / float(size.x), (0.5 + row) / float(size.y));
}

SkyViewPlace sky_view_texel(ivec2 texel, ivec2 size) {
  int half_rows = size.y / 2;
  SkyViewPlace place;
  place.across = float(texel.x) / float(size.x - 1);
  place.below = texel.y >= half_rows;
  int from_horizon = place.below ? texel.y - half_rows : half_rows - 1 - texel.y;
  place.from_horizon = float(from_horizon) / float(half_rows - 1);
  return place;
}
// [/texels]

#endif
