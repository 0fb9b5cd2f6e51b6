// The march's knobs as push constants carry them: CloudLightPush of chapters/18_cloud_light/cloud_light.hpp.
#ifndef WELKIN_MARCH_PUSH_GLSL
#define WELKIN_MARCH_PUSH_GLSL

struct CloudLightPush {
  ivec4 columns;  // as chapter 17's CloudMarch: steps, detail, grid method, grid steps
  ivec4 light;    // view steps, samples to the sun, escape directions, samples in each
  ivec4 orders;   // which stand-in, octaves, 1: light of sky and ground
  vec4 octaves;   // a, b, c, powder
  vec4 sun;       // xyz: unit, global frame; w: escape refresh
};

CloudMarchSettings march_settings(CloudLightPush push) {
  CloudMarchSettings settings;
  settings.sun = push.sun.xyz;
  settings.steps = push.light.x;
  settings.offset = 0.5;
  settings.light_samples = push.light.y;
  settings.escape_directions = push.light.z;
  settings.escape_samples = push.light.w;
  settings.escape_refresh = push.sun.w;
  settings.method = push.orders.x;
  settings.octaves = Octaves(push.orders.y, push.octaves.x, push.octaves.y, push.octaves.z);
  settings.powder = push.octaves.w;
  settings.ambient = float(push.orders.z);
  settings.detail = push.columns.y;
  settings.grid_method = push.columns.z;
  return settings;
}

#endif
