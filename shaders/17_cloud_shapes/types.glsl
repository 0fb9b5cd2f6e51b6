// Remapping, and the eight types of cloud as profiles over the relative height of a layer. Pure, also valid C++.
//
// A type is a number 0 ... 1 with a name at each seventh: 0 stratus, 1/7 stratocumulus, 2/7 cumulus, 3/7 cumulus
// congestus, 4/7 cumulonimbus, 5/7 altocumulus, 6/7 altostratus, 1 nimbostratus. Between two names it is a mixture.
#ifndef WELKIN_CLOUD_TYPES_GLSL
#define WELKIN_CLOUD_TYPES_GLSL

// [remap]
// Carries a ... b to c ... d, linearly and without a limit; a and b differ.
float remap(float x, float a, float b, float c, float d) { return c + (x - a) / (b - a) * (d - c); }

// What is left of x above a threshold, stretched to 0 ... 1 again: remap(x, threshold, 1, 0, 1) within its bounds. The
// bounds are ordered whatever the threshold is: at 1 and above nothing is left, and nothing is divided by 0.
float above(float x, float threshold) {
  return threshold < 1.0 ? clamp((x - threshold) / (1.0 - threshold), 0.0, 1.0) : 0.0;
}
// [/remap]

// [types]
// From where to where the cloud begins and ends: (begins, full, thins out from, ends), shares of the layer's height.
vec4 type_profile(int k) {
  if (k == 0) return vec4(0.00, 0.05, 0.14, 0.24);  // stratus: a low sheet
  if (k == 1) return vec4(0.02, 0.08, 0.20, 0.42);  // stratocumulus: lumps
  if (k == 2) return vec4(0.00, 0.05, 0.22, 0.72);  // cumulus: a flat base and a dome
  if (k == 3) return vec4(0.00, 0.04, 0.40, 0.95);  // cumulus congestus: towers
  if (k == 4) return vec4(0.00, 0.03, 0.84, 1.00);  // cumulonimbus: to the top, where it spreads
  if (k == 5) return vec4(0.50, 0.56, 0.62, 0.78);  // altocumulus: small lumps at mid height
  if (k == 6) return vec4(0.42, 0.50, 0.60, 0.72);  // altostratus: a veil
  return vec4(0.00, 0.06, 0.55, 0.74);              // nimbostratus: thick and without holes
}

// (solid, billows, anvil): how far the sheet is without holes at full coverage, how much detail erodes its edge, and how
// far it spreads below the layer's top.
vec3 type_texture(int k) {
  if (k == 0) return vec3(0.9, 0.25, 0.0);
  if (k == 1) return vec3(0.3, 0.60, 0.0);
  if (k == 2) return vec3(0.0, 1.00, 0.0);
  if (k == 3) return vec3(0.0, 1.00, 0.0);
  if (k == 4) return vec3(0.1, 0.90, 1.0);
  if (k == 5) return vec3(0.0, 0.70, 0.0);
  if (k == 6) return vec3(0.8, 0.20, 0.0);
  return vec3(1.0, 0.30, 0.0);
}

struct CloudType {
  vec4 profile;
  float solid;
  float billows;
  float anvil;
};

CloudType cloud_type(float type) {
  float place = clamp(type, 0.0, 1.0) * 7.0;
  int k = min(int(place), 6);
  float share = place - float(k);
  vec3 character = mix(type_texture(k), type_texture(k + 1), share);
  CloudType mixed;
  mixed.profile = mix(type_profile(k), type_profile(k + 1), share);
  mixed.solid = character.x;
  mixed.billows = character.y;
  mixed.anvil = character.z;
  return mixed;
}
// [/types]

// [profile]
// 0 ... 1 at a relative height. `tops`: how high the cloud grows at this place: 0, to 55 % of
// what its type allows; 1, to all of it.
float height_profile(vec4 profile, float height, float tops) {
  float h = profile.x + (height - profile.x) / (0.55 + 0.45 * tops);
  float rises = clamp((h - profile.x) / max(profile.y - profile.x, 1.0e-4), 0.0, 1.0);
  float falls = clamp((profile.w - h) / max(profile.w - profile.z, 1.0e-4), 0.0, 1.0);
  return rises * falls * (2.0 - falls);  // a dome
}
// [/profile]

#endif
