// Maps view directions from one altitude to texture coordinates of the sky view table, relative to the sun's azimuth
// and the horizon, and back. Pure functions, also valid C++; km.
//
//   azimuth coordinate     x = sin(phi/2)                  phi: azimuth from the sun's, 0 … pi (the sky is symmetric)
//   elevation coordinate   s = sqrt(n)                     above the horizon
//                          s = sqrt(n (1 + k) / (n + k))   below the horizon; k = m + sqrt(m), m = tan(dip/2)
//   n = tan(l/2) / tan(l_max/2)     l: angle from the horizon, l_max: that of the zenith or the nadir
//   dip: angle of the horizon below the horizontal
//
// Half angles need no inverse trigonometry: their tangents are quotients of vector components. The square root crowds
// rows at the horizon, where the sky changes fastest. Below the horizon the length of a ray falls to a few tenths
// within one dip (0.02 degrees for an eye half a metre up), and k crowds rows within a few dips. Sky and ground are two
// halves of the table, each with its own rows, and no look-up blends them: the horizon stays sharp.
#ifndef WELKIN_SKY_VIEW_MAP_GLSL
#define WELKIN_SKY_VIEW_MAP_GLSL

#include "03_planet_and_rays/ray_sphere.glsl"

// Coordinates of a direction in the table: x and s in 0 … 1, and the half of the table.
struct SkyViewCoordinates {
  float azimuth_coordinate;    // x
  float elevation_coordinate;  // s
  bool below_horizon;
};

// [horizon]
// tan(l_max/2), of the nadir or the zenith. horizon: cosine and sine of the horizon's zenith angle; the cosine is <= 0,
// so neither form cancels.
float max_half_angle_tangent(vec2 horizon, bool below_horizon) {
  return below_horizon ? horizon.y / (1.0 - horizon.x) : (1.0 - horizon.x) / horizon.y;
}

// k of the rows below the horizon. The minimum is for an eye on the ground, from which downward rays have no length.
float below_horizon_knee(vec2 horizon) {
  float m = max(-horizon.x / (1.0 + horizon.y), 1.0e-6);
  return m + sqrt(m);
}
// [/horizon]

// [place]
// view, sun: unit vectors in the local frame, z up. sin(phi/2) is half the distance between their horizontal unit
// vectors. Where one of them is vertical, phi is undefined and set to 0.
SkyViewCoordinates sky_view_coordinates(vec2 horizon, vec3 view, vec3 sun) {
  float sine = sqrt(view.x * view.x + view.y * view.y);
  float sun_sine = sqrt(sun.x * sun.x + sun.y * sun.y);
  SkyViewCoordinates coordinates;
  coordinates.azimuth_coordinate = 0.0;
  if (sine > 0.0 && sun_sine > 0.0) {
    float x = view.x / sine - sun.x / sun_sine;
    float y = view.y / sine - sun.y / sun_sine;
    coordinates.azimuth_coordinate = min(0.5 * sqrt(x * x + y * y), 1.0);
  }
  // Sine and cosine of the angle from the horizon, a difference of zenith angles.
  float s = horizon.y * view.z - horizon.x * sine;
  float c = horizon.x * view.z + horizon.y * sine;
  coordinates.below_horizon = s < 0.0;
  float t = abs(s) / max(1.0 + c, 1.0e-20);
  float n = min(t / max_half_angle_tangent(horizon, coordinates.below_horizon), 1.0);
  float knee = below_horizon_knee(horizon);
  coordinates.elevation_coordinate = sqrt(coordinates.below_horizon ? n * (1.0 + knee) / (n + knee) : n);
  return coordinates;
}

// The inverse: (cosine, sine) of the zenith angle of a row, and (cosine, sine) of the azimuth of a column. The row at
// the horizon is moved off it, so that it stays on its side whatever the rounding: above by 2e-6 rad, below by a
// hundred-thousandth of the dip or 8e-8 rad, whichever is less, which changes a ray's length by 0.5 %.
vec2 sky_view_zenith(vec2 horizon, float elevation_coordinate, bool below_horizon) {
  float s2 = elevation_coordinate * elevation_coordinate;
  float knee = below_horizon_knee(horizon);
  float range = max_half_angle_tangent(horizon, below_horizon);
  float t = below_horizon ? max(knee * s2 / (1.0 + knee - s2) * range, min(1.0e-5 * knee * knee, 4.0e-8))
                          : max(s2, 1.0e-6) * range;
  float c = (1.0 - t * t) / (1.0 + t * t);
  float s = (below_horizon ? -2.0 : 2.0) * t / (1.0 + t * t);
  return vec2(clamp(horizon.x * c + horizon.y * s, -1.0, 1.0), max(horizon.y * c - horizon.x * s, 0.0));
}

vec2 sky_view_azimuth(float x) {  // x: azimuth coordinate
  return vec2(1.0 - 2.0 * x * x, 2.0 * x * sqrt(max((1.0 - x) * (1.0 + x), 0.0)));
}
// [/place]

// [texels]
// From coordinates to texture coordinates of a table of size (w, h), h even, and from a texel's centre to coordinates:
// exact inverses. Rows run from the zenith down to the horizon, then from the horizon down to the nadir.
vec2 sky_view_uv(SkyViewCoordinates coordinates, ivec2 size) {
  float half_rows = float(size.y / 2);
  float row = coordinates.below_horizon ? half_rows + coordinates.elevation_coordinate * (half_rows - 1.0)
                                        : (1.0 - coordinates.elevation_coordinate) * (half_rows - 1.0);
  return vec2((0.5 + coordinates.azimuth_coordinate * float(size.x - 1)) / float(size.x), (0.5 + row) / float(size.y));
}

SkyViewCoordinates sky_view_of_texel(ivec2 texel, ivec2 size) {
  int half_rows = size.y / 2;
  SkyViewCoordinates coordinates;
  coordinates.azimuth_coordinate = float(texel.x) / float(size.x - 1);
  coordinates.below_horizon = texel.y >= half_rows;
  int rows_from_horizon = coordinates.below_horizon ? texel.y - half_rows : half_rows - 1 - texel.y;
  coordinates.elevation_coordinate = float(rows_from_horizon) / float(half_rows - 1);
  return coordinates;
}
// [/texels]

#endif
