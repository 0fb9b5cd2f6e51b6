// A vertex of the terrain's mesh: its place follows from its number, its height from the map. Depth only, no fragment shader.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "11_aerial_perspective/terrain.glsl"

layout(constant_id = 0) const int CELLS = 128;
layout(binding = 0) uniform sampler2D height_map;
layout(push_constant) uniform Push {
  vec4 right;     // of the camera, global frame, times tan(fov/2) times aspect; w: the planet's radius, km
  vec4 up;        // times tan(fov/2); w: extent of the map, km
  vec4 forward;   // w: near plane, km
  vec4 position;  // of the camera, km; w: cell, km
  vec4 ring;      // xy: middle of the ring, zw: place below the camera, km
};

// [ring]
void main() {
  const float i = float(gl_VertexIndex % (CELLS + 1)), j = float(gl_VertexIndex / (CELLS + 1));
  const vec2 half_map = vec2(0.5 * up.w);
  const vec2 wanted = ring_vertex(i, j, float(CELLS), ring.xy, position.w, ring.zw);
  const vec2 place = clamp(wanted, -half_map, half_map);
  // At the rim of the map the mesh goes down to the sphere, so that nothing is seen below it.
  const bool inside = all(lessThan(abs(place), half_map));
  const float height = inside ? textureLod(height_map, map_uv(place, up.w), 0.0).r : 0.0;
  const vec3 point = on_planet(right.w, place, height) - position.xyz;
  const float z = dot(point, forward.xyz);
  gl_Position = vec4(dot(point, right.xyz) / dot(right.xyz, right.xyz), -dot(point, up.xyz) / dot(up.xyz, up.xyz), forward.w, z);
}
// [/ring]
