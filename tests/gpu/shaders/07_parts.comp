// Single functions of chapter 07 over arrays. Reads 8 floats an item: which function, then its arguments; writes 8 floats.
#version 460
#extension GL_GOOGLE_include_directive : require
layout(local_size_x = 64) in;
layout(constant_id = 0) const bool HAS_RAYLEIGH = true;
layout(constant_id = 1) const bool HAS_MIE = true;
layout(constant_id = 2) const bool HAS_OZONE = true;
layout(constant_id = 3) const int MIE_PHASE = 0;
layout(constant_id = 4) const int TRACKING = 3;
const bool HERO = true;
const bool ENVIRONMENT = false;
const bool SPREAD = true;
const bool SURFACES = false;
#include "07_ground_truth/accumulate.glsl"
#include "07_ground_truth/path.glsl"
#include "../tests/gpu/shaders/atmosphere_of.glsl"

layout(binding = 0, std430) readonly buffer Inputs {
  float inputs[];
};
layout(binding = 1, std430) writeonly buffer Outputs {
  float outputs[];
};
layout(push_constant) uniform Push {
  uint count;
};

// Earth, its aerosol with g as given, second lobe and weight.
Atmosphere earth(float g, float second_g, float shape) {
  return atmosphere_of(vec4(5.802e-3, 13.558e-3, 33.1e-3, 8.0), vec4(vec3(3.996e-3), 1.2), vec4(vec3(4.440e-3), g),
                    vec4(0.650e-3, 1.881e-3, 0.085e-3, 25.0), vec4(6360.0, 100.0, 15.0, 0.00465), vec4(vec3(0.3), second_g), vec4(vec3(1.0), shape));
}

void main() {
  const uint item = gl_GlobalInvocationID.x;
  if (item >= count) return;
  const uint first = 8 * item;
  const int what = int(inputs[first]);
  const vec4 a = vec4(inputs[first + 1], inputs[first + 2], inputs[first + 3], inputs[first + 4]);
  const vec4 b = vec4(inputs[first + 5], inputs[first + 6], inputs[first + 7], 0.0);
  vec4 low = vec4(0.0), high = vec4(0.0);
  if (what == 0) {  // random numbers: path, sample, seed, draws
    Random random = random_stream(uint(a.x), uint(a.y), uint(a.z));
    for (int i = 0; i <= int(a.w); ++i) random = draw(random);
    low = random.value;
  }
  if (what == 1) {  // a term added n times, carefully and plainly: term, n
    Accumulated total = Accumulated(vec4(0.0), vec4(0.0));
    float plain = 0.0;
    for (int i = 0; i < int(a.y); ++i) {
      total = accumulated(total, vec3(a.x));
      plain += a.x;
    }
    low = vec4(mean_radiance(total, a.y), standard_error(total, a.y));
    high.x = plain;
  }
  if (what == 2) {  // scattering turn: 0 rayleigh, 1 mie; u, u; g, second g, shape
    const Atmosphere air = earth(b.x, b.y, b.z);
    const Turn turn = a.x < 0.5 ? rayleigh_turn(a.y, a.z) : kept_mie_turn(air, a.y, a.z, random_stream(item, 0u, 1u)).turn;
    const vec3 axis = normalize(vec3(a.w, 0.3, 0.6 - a.w));
    const vec3 to = turned(axis, turn, a.z);
    low = vec4(turn.one_minus_nu, turn.one_plus_nu, one_minus_cosine(axis, to), length(to));
  }
  if (what == 3) {  // majorant against density: altitude, zenith cosine, scale height, share of the length
    const float sine = sqrt((1.0 - a.y) * (1.0 + a.y));
    const bool down = a.y < 0.0 && tangent_altitude(6360.0, a.x, a.y, sine) < 0.0;
    const PathSegment segment = segment_from(6360.0, 100.0, a.x, a.y, sine, down);
    const float t = segment.length_km * a.w;
    Majorant piece = majorant_from(segment, a.z, 0.0);
    float from = 0.0;
    for (int i = 0; i < 8 && piece.end_km < t; ++i) {
      from = piece.end_km;
      piece = majorant_from(segment, a.z, from);
    }
    const float density = exp(-max(altitude_along(6360.0, a.x, a.y, t), 0.0) / a.z);
    low = vec4(piece.density * exp(-piece.falls_per_km * (t - from)), density, segment.length_km, majorant_column(segment, a.z));
    const vec3 column = columns_along(earth(0.8, 0.0, 0.0), segment, segment.length_km, down ? 0.0 : 100.0);
    high = vec4(column, 0.0);
  }
  if (what == 4) {  // ratio tracking to the sun: altitude, zenith cosine, path, paths
    vec3 sum = vec3(0.0), squares = vec3(0.0);
    bool finished = true;
    for (int i = 0; i < int(a.w); ++i) {
      const Random random = random_stream(uint(a.z), uint(i), 7u);
      const Sunlight light = sunlight(earth(0.8, 0.0, 0.0), a.x, a.y, TRACKING, TRACKING == kTrackNaive ? 1 : 24, random);
      sum += light.transmittance;
      squares += light.transmittance * light.transmittance;
      finished = finished && light.finished;
    }
    low = vec4(sum, finished ? 1.0 : 0.0);
    high = vec4(squares, 0.0);
  }
  for (int i = 0; i < 4; ++i) {
    outputs[first + i] = low[i];
    outputs[first + 4 + i] = high[i];
  }
}
