// Detail finer than the height map: noise of thirteen scales from 1.2 km to 8 mm, each 2.7 times finer than the one
// before. Pure functions; km. Its slopes and tones shade the ground wherever it is seen; near the camera its middle
// scales are also relief that a ray can meet.
#ifndef WELKIN_DETAIL_GLSL
#define WELKIN_DETAIL_GLSL

const int kScales = 13;
const float kWidest_km = 1.168;
const float kFiner = 0.37;
const float kSteepness = 0.1;  // of a scale: its height is this times its wavelength times noise, 0 ... 1

// A pseudorandom number, 0 ... 1, for each lattice point, the same on every device.
float lattice(int i, int j) {
  uint h = uint(i) * 0x9E3779B1u ^ uint(j) * 0x85EBCA77u;
  h ^= h >> 15;
  h *= 0x2C1B3C6Du;
  h ^= h >> 12;
  h *= 0x297A2D39u;
  return float(h >> 8) * (1.0 / 16777216.0);
}

// Value noise, 0 ... 1, and its derivatives: (value, d/dx, d/dy).
vec3 value_noise(vec2 at) {
  vec2 cell = floor(at);
  int i = int(cell.x);
  int j = int(cell.y);
  float u = at.x - cell.x;
  float v = at.y - cell.y;
  float a = u * u * (3.0 - 2.0 * u);
  float b = v * v * (3.0 - 2.0 * v);
  float c00 = lattice(i, j);
  float c10 = lattice(i + 1, j);
  float c01 = lattice(i, j + 1);
  float c11 = lattice(i + 1, j + 1);
  float low = c00 + a * (c10 - c00);
  float high = c01 + a * (c11 - c01);
  float across = (c10 - c00) + b * ((c11 - c01) - (c10 - c00));
  return vec3(low + b * (high - low), 6.0 * u * (1.0 - u) * across, 6.0 * v * (1.0 - v) * (high - low));
}

// Every scale is turned by atan(3/4) against the one before, so that lattices never line up.
vec2 turned(vec2 v) { return vec2(0.8 * v.x - 0.6 * v.y, 0.6 * v.x + 0.8 * v.y); }
vec2 turned_back(vec2 v) { return vec2(0.8 * v.x + 0.6 * v.y, 0.8 * v.y - 0.6 * v.x); }

// [detail]
struct Detail {
  float patches;  // sum over the scales of 60 m and more, about -0.5 ... 0.5: what grows where
  float grain;    // over those of some metres
  float blades;   // over the finest
  float sharp;    // share of the scales that are kept: how sharp a border can be
  vec2 tilt;      // slope of those of 60 m and less, in units of kSteepness
};

// footprint_km: width of a pixel on the ground. Scales whose waves are finer than a pixel are left out: they would
// sparkle.
Detail detail_at(vec2 place_km, float footprint_km) {
  Detail detail;
  detail.patches = 0.0;
  detail.grain = 0.0;
  detail.blades = 0.0;
  detail.sharp = 0.0;
  detail.tilt = vec2(0.0, 0.0);
  float wave_km = kWidest_km;
  int scale = 0;
  for (; scale < kScales; scale++) {
    float kept = clamp(1.6 - 2.4 * footprint_km / wave_km, 0.0, 1.0);
    if (kept <= 0.0) break;
    vec3 rough = value_noise(place_km / wave_km + vec2(17.0 * float(scale), 5.0));
    if (scale < 4) detail.patches += kept * 0.36 * (rough.x - 0.5);
    else if (scale < 8) detail.grain += kept * 0.4 * (rough.x - 0.5);
    else detail.blades += kept * 0.4 * (rough.x - 0.5);
    if (scale < 10) detail.sharp += kept * 0.1;
    if (scale >= 3) detail.tilt += vec2(rough.y, rough.z) * kept;  // wider slopes are the map's
    detail.tilt = turned(detail.tilt);
    place_km = turned(place_km);
    wave_km *= kFiner;
  }
  for (; scale > 0; scale--) detail.tilt = turned_back(detail.tilt);
  return detail;
}
// [/detail]

// [relief]
// Height that scales 5 to 7, waves of 8, 3 and 1 m, add to the map near the camera: 0 ... kRelief_km, less farther
// away.
const float kRelief_km = 0.00121;
const float kReliefReach_km = 0.25;
const int kReliefSteps = 12;

float relief_at(vec2 place_km) {
  // Turned five times: (0.8 + 0.6 i)^5.
  vec2 place = vec2(-0.99712 * place_km.x + 0.07584 * place_km.y, -0.07584 * place_km.x - 0.99712 * place_km.y);
  float wave_km = 0.0080991;  // kWidest_km kFiner^5
  float height = 0.0;
  for (int scale = 5; scale < 8; scale++) {
    height += kSteepness * wave_km * value_noise(place / wave_km + vec2(17.0 * float(scale), 5.0)).x;
    place = turned(place);
    wave_km *= kFiner;
  }
  return height;
}

// Where a ray that meets the map's surface at t_km meets the relief that stands on it: equal steps through the relief's
// layer, then linear interpolation in the step that crosses it. The surface below is taken as a plane. approach: how
// much nearer the ray comes to it per km; speed: how far the ray's place on the map moves per km.
float meet_relief(vec2 place_km, vec2 speed, float t_km, float approach) {
  float height = kRelief_km * (1.0 - t_km / kReliefReach_km);
  float layer_km = min(height / max(approach, 0.02), 0.9 * t_km);  // along the ray
  int steps = height > 0.0 ? kReliefSteps : 0;
  float over_before = layer_km * approach;
  for (int i = 1; i <= steps; i++) {
    float to_go = layer_km * (1.0 - float(i) / float(kReliefSteps));  // to the surface
    float over = to_go * approach - (height / kRelief_km) * relief_at(place_km - speed * to_go);
    if (over <= 0.0) {
      float step_km = layer_km / float(kReliefSteps);
      return t_km - to_go - step_km * over / min(over - over_before, -1.0e-12);
    }
    over_before = over;
  }
  return t_km;
}
// [/relief]

#endif
