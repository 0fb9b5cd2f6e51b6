// What surface.glsl asks for, read from the images slope_map, cover_map and sign_boards of the including pass.
#ifndef WELKIN_SURFACE_MAPS_GLSL
#define WELKIN_SURFACE_MAPS_GLSL

#include "11_aerial_perspective/signs.glsl"

vec2 slope_at(vec2 uv) { return textureLod(slope_map, uv, 0.0).rg; }
vec4 cover_at(vec2 uv) { return textureLod(cover_map, uv, 0.0); }

int sign_count() { return textureSize(sign_boards, 0).y; }
SignBoard sign_board(int k) {
  const vec4 foot = texelFetch(sign_boards, ivec2(0, k), 0);
  return SignBoard(foot.xyz, foot.w, texelFetch(sign_boards, ivec2(1, k), 0).xyz, texelFetch(sign_boards, ivec2(2, k), 0).xyz, texelFetch(sign_boards, ivec2(3, k), 0).xyz);
}

#endif
