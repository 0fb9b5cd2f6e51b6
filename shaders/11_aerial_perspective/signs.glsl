// A row of signs 1, 2, 5, 10, 20, 50 and 100 km away, so that distance can be seen. Pure functions; km, global frame.
//
// Each stands upright, faces the scene's place, and is as large as it is far: all look the same size from there, 10
// degrees above the horizontal and 7.4 degrees apart. A board is 10 hundredths of its distance wide and 6 high.
#ifndef WELKIN_SIGNS_GLSL
#define WELKIN_SIGNS_GLSL

const int kSigns = 7;

// A sign as chapters/11_aerial_perspective/signs.cpp places it, and its unit vectors: along the board, along the post,
// and towards the scene's place. With (e, n, z) the foot and d = |(e, n)|, up is (e, n, R + z) / R.
struct SignBoard {
  vec3 foot_km;
  float distance_km;
  vec3 side, up, normal;
};

SignBoard sign_board(vec4 place_km, float ground_radius_km) {
  float d = place_km.w;
  float up_z = 1.0 + place_km.z / ground_radius_km;
  SignBoard sign;
  sign.foot_km = place_km.xyz;
  sign.distance_km = d;
  sign.side = vec3(place_km.y / d, place_km.x / -d, 0.0);
  sign.up = vec3(place_km.x / ground_radius_km, place_km.y / ground_radius_km, up_z);
  sign.normal = vec3(up_z * place_km.x / -d, up_z * place_km.y / -d, d / ground_radius_km);
  return sign;
}

// Where a ray meets a sign: t_km < 0 if it does not. paint: reflectance; share: of the pixel that it covers.
struct SignHit {
  float t_km;
  float paint;
  float share;
  vec3 normal;
};

// Whether (x, y) is on the stroke of a seven-segment digit; the digit fills 0 ... 1 by 0 ... 2, y up.
bool on_digit(int digit, float x, float y) {
  int lit = digit == 0 ? 63 : (digit == 1 ? 6 : (digit == 2 ? 91 : 109));  // a b c d e f g from bit 0; 5: 109
  float w = 0.22;
  if (x < 0.0 || x > 1.0 || y < 0.0 || y > 2.0) return false;
  bool on = (lit & 1) != 0 && y > 2.0 - w;
  on = on || ((lit & 2) != 0 && x > 1.0 - w && y > 1.0);
  on = on || ((lit & 4) != 0 && x > 1.0 - w && y < 1.0);
  on = on || ((lit & 8) != 0 && y < w);
  on = on || ((lit & 16) != 0 && x < w && y < 1.0);
  on = on || ((lit & 32) != 0 && x < w && y > 1.0);
  return on || ((lit & 64) != 0 && abs(y - 1.0) < 0.5 * w);
}

// The board's paint at (u, v), -1 ... 1 by 0 ... 1: the number of km in black on white, and a black and white band below.
float board_paint(int k, float u, float v) {
  if (abs(u) > 0.96 || v > 0.95 || v < 0.04) return 0.02;
  if (v < 0.26) return u < 0.0 ? 0.02 : 0.85;
  int step = k % 3;
  int first = step == 0 ? 1 : (step == 1 ? 2 : 5);
  int digits = k / 3 + 1;
  float size = 0.26;  // of a digit's width and half its height, in half widths of the board
  float x = (u + 0.5 * (1.45 * float(digits) - 0.45) * size) / size;
  float y = (v - 0.34) / 0.26;
  bool ink = on_digit(first, x, y);
  for (int zero = 1; zero < digits; zero++) ink = ink || on_digit(0, x - 1.45 * float(zero), y);
  return ink ? 0.02 : 0.85;
}

// Share of an interval of width w about x that lies between low and high.
float covered(float x, float low, float high, float w) {
  return clamp((min(x + 0.5 * w, high) - max(x - 0.5 * w, low)) / w, 0.0, 1.0);
}

// [sign]
SignHit meet_sign(SignBoard sign, int k, float ground_radius_km, vec3 start_km, vec3 direction, float pixel) {
  SignHit hit;
  hit.share = 0.0;
  hit.t_km = -1.0;
  hit.paint = 0.0;
  hit.normal = sign.normal;
  float d = sign.distance_km;
  vec3 foot = sign.foot_km - start_km;
  float facing = dot(direction, sign.normal);
  if (abs(facing) < 1.0e-6) return hit;
  float t = dot(foot, sign.normal) / facing;
  if (t <= 0.0) return hit;
  // The board's plane is met at direction t - foot. Most rays pass to the left or right: they need no more than u.
  float w = t * pixel / d;  // of a pixel, in distances of the sign
  float u = (t * dot(direction, sign.side) - dot(foot, sign.side)) / d;
  if (abs(u) >= 0.05 + 0.5 * w) return hit;
  float height_km = t * dot(direction, sign.up) - dot(foot, sign.up);
  float v = height_km / d - 0.5 * d / ground_radius_km;  // the ground there is that much lower
  // Of board and post as much as is in a pixel's square; what is painted there, by nine points of it.
  float board = covered(u, -0.05, 0.05, w) * covered(v, 0.15, 0.21, w);
  float post = height_km > 0.0 ? covered(u, -0.0015, 0.0015, w) * covered(v, -1.0, 0.15, w) : 0.0;
  if (board + post <= 0.0) return hit;
  float paint = 0.0;
  for (int i = 0; i < 9; i++) {
    float x = clamp(u + w * (float(i % 3) - 1.0) / 3.0, -0.05, 0.05);
    float y = clamp(v + w * (float(i / 3) - 1.0) / 3.0, 0.15, 0.21);
    if (board > 0.0) paint += board_paint(k, x / 0.05, (y - 0.15) / 0.06) / 9.0;
  }
  hit.t_km = t;
  hit.share = min(board + post, 1.0);
  hit.paint = (board * paint + post * 0.3) / (board + post);
  return hit;
}
// [/sign]

#endif
