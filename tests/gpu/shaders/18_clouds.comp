// Light of one body of cloud along rays: by paths, or by the marches of chapter 18. Item as CloudItem in 18_clouds.hpp: 32
// floats in, 4 out. A grid's samples and bounds come in a buffer, header first.
#version 460
#extension GL_GOOGLE_include_directive : require
layout(local_size_x = 64) in;
layout(constant_id = 0) const int METHOD = 0;  // 0: paths, 1: march, 2: order 1, converged
layout(constant_id = 1) const bool CLOUD_ENVIRONMENT = false;
layout(constant_id = 2) const int CLOUD_KINDS = 13;  // layers and balls alone, or also a grid
const bool HAS_RAYLEIGH = false;
const bool HAS_MIE = false;
const bool HAS_OZONE = false;
const int MIE_PHASE = 0;
#include "interop/cloud.h"

layout(binding = 0, std430) readonly buffer Inputs {
  float inputs[];
};
layout(binding = 1, std430) writeonly buffer Outputs {
  float outputs[];
};
layout(binding = 2, std430) readonly buffer Grid {
  float grid[];
};
layout(push_constant) uniform Push {
  uint count;
};

// One body a ray.
struct OneCloud {
  int count;
  float ground_radius_km;
  float ceiling_km;
  CloudBody bodies[1];
};
OneCloud clouds;

int grid_size(int axis) { return int(grid[axis]); }
float grid_texel(int i, int j, int k) { return grid[9 + (k * grid_size(1) + j) * grid_size(0) + i]; }
float grid_filtered(vec3 texel) {
  const vec3 at = max(texel - 0.5, vec3(0.0));
  const ivec3 low = min(ivec3(at), ivec3(grid_size(0) - 2, grid_size(1) - 2, grid_size(2) - 2));
  const vec3 s = at - vec3(low);
  float sum = 0.0;
  for (int n = 0; n < 8; ++n) {
    const ivec3 up = ivec3(n & 1, (n >> 1) & 1, n >> 2);
    const vec3 w = mix(vec3(1.0) - s, s, vec3(up));
    sum += w.x * w.y * w.z * grid_texel(low.x + up.x, low.y + up.y, low.z + up.z);
  }
  return sum;
}
float grid_bound(int i, int j, int k) {
  return grid[9 + grid_size(0) * grid_size(1) * grid_size(2) + (k * grid_size(7) + j) * grid_size(6) + i];
}
vec4 weather_texel(vec2 uv) { return vec4(0.0); }
vec4 base_noise(vec3 uvw) { return vec4(0.0); }
vec4 detail_noise(vec3 uvw) { return vec4(0.0); }
vec4 curl_noise(vec2 uv) { return vec4(0.0); }
#include "17_cloud_shapes/optical_depth.glsl"

// As block.glsl of chapter 17 has it.
float cloud_optical_depth(CloudRay ray, CloudMarch march) { return body_optical_depth(clouds.bodies[0], clouds.ground_radius_km, ray, march); }
#include "18_cloud_light/cloud_march.glsl"
#include "18_cloud_light/cloud_path.glsl"
#include "18_cloud_light/first_order.glsl"

float in_at(uint item, int k) { return inputs[32 * item + k]; }
vec3 three(uint item, int k) { return vec3(in_at(item, k), in_at(item, k + 1), in_at(item, k + 2)); }

CloudBody body_of(uint item) {
  CloudBody body;
  body.kind = int(in_at(item, 0));
  body.extinction_per_km = in_at(item, 1);
  body.single_scattering_albedo = in_at(item, 2);
  body.largest_density = 1.0;
  body.lobe_g = in_at(item, 3);
  body.lobe_alpha = in_at(item, 4);
  body.second_g = in_at(item, 5);
  body.second_alpha = in_at(item, 6);
  body.lobe_weight = in_at(item, 7);
  body.base_km = in_at(item, 17);
  body.top_km = in_at(item, 18);
  body.radius_km = in_at(item, 18);
  body.place_km = three(item, 19);
  body.axis = vec3(grid[3], grid[4], grid[5]);
  body.samples_x = grid_size(0);
  body.samples_y = grid_size(1);
  body.samples_z = grid_size(2);
  body.first_slice = 0;
  return body;
}

void main() {
  const uint item = gl_GlobalInvocationID.x;
  if (item >= count) return;
  const CloudBody body = body_of(item);
  clouds.count = 1;
  clouds.bodies[0] = body;
  clouds.ground_radius_km = in_at(item, 23);
  clouds.ceiling_km = in_at(item, 24);
  // From the body's place: two floats know a point better than one.
  const CloudPoint eye = CloudPoint(body.place_km, three(item, 8), in_at(item, 22));
  CloudRay ray = cloud_ray_from(eye, clouds.ground_radius_km, three(item, 11));
  if (in_at(item, 25) > -2.0) {  // the cosine of zenith, where the test has it in double
    ray.mu = in_at(item, 25);
    ray.sine = in_at(item, 26);
    ray.end_km = ground_end(clouds.ground_radius_km, eye.altitude_km, ray.mu, ray.sine);
  }
  ray = below_ceiling(clouds.ground_radius_km, clouds.ceiling_km, ray);
  if (METHOD == 2) {
    outputs[4 * item] = first_order_of_clouds(ray, three(item, 14), CloudMarch(128, kWithCurledDetail, kGridExact, 1, 0.5), RayPart(int(in_at(item, 30)), int(in_at(item, 31))));
    return;
  }
  if (METHOD == 1) {  // samples: steps; side rays: which orders; path: samples to the sun; seed: escape samples; orders: octaves
    CloudMarchSettings march;
    march.sun = three(item, 14);
    march.steps = int(in_at(item, 29));
    march.offset = 0.5;
    march.light_samples = int(in_at(item, 30));
    march.escape_samples = int(in_at(item, 31)) % 10;
    march.escape_directions = int(in_at(item, 31)) / 10 % 10;
    march.escape_refresh = float(int(in_at(item, 31)) / 100) / 100.0;
    march.method = int(in_at(item, 27));
    march.octaves = Octaves(int(in_at(item, 28)), 0.5, 0.5, 0.5);
    march.powder = 0.0;
    march.ambient = 1.0;
    march.detail = kWithCurledDetail;
    march.grid_method = kGridFiltered;
    const CloudLight light = march_cloud_light(ray, march);
    outputs[4 * item] = light.radiance;
    outputs[4 * item + 1] = light.tau;
    outputs[4 * item + 2] = light.skylight.x + light.skylight.y;
    outputs[4 * item + 3] = light.blurred;
    return;
  }
  const int samples = int(in_at(item, 29));
  CloudPathSettings settings;
  settings.orders = int(in_at(item, 28));
  settings.detail = kWithCurledDetail;
  settings.side_rays = in_at(item, 27);
  settings.ground_albedo = CLOUD_ENVIRONMENT ? 1.0 : 0.0;  // black; white in a white furnace
  settings.sun = three(item, 14);
  float sum = 0.0, squares = 0.0, vertices = 0.0;
  uint finished = 0u;  // a software driver ends every loop of an invocation after 65,535 turns of all of them
  for (int i = 0; i < samples; ++i) {
    const CloudPathLight light = trace_cloud_path(settings, ray, random_stream(uint(in_at(item, 30)), uint(i), uint(in_at(item, 31))));
    sum += light.radiance;
    squares += light.radiance * light.radiance;
    vertices += float(light.vertices);
    if (light.finished) finished++;
  }
  outputs[4 * item] = sum / float(samples);
  outputs[4 * item + 1] = squares / float(samples);
  outputs[4 * item + 2] = vertices / float(samples);
  outputs[4 * item + 3] = float(samples) - float(finished);
}
