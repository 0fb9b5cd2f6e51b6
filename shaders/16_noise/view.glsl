// How a texture is shown: a rectangle of the picture, a channel or three, and a histogram over it.
#ifndef WELKIN_NOISE_VIEW_GLSL
#define WELKIN_NOISE_VIEW_GLSL

layout(binding = 1, rgba32f) uniform writeonly image2D target;
layout(push_constant) uniform Push {
  ivec4 rectangle;   // x, y, width, height in pixels
  int channel;       // 0 ... 3; 4: the first three as colours
  float tiles;       // that fit into the rectangle's height
  float slice;       // 0 ... 1, of a volume
  float mip;
  int is_signed;     // numbers are -1 ... 1
  int histogram;     // of how many texels there is one; 0: of none
} push;

vec3 shown(vec4 value) {
  if (push.is_signed != 0) value = 0.5 + 0.5 * value;
  return push.channel < 4 ? vec3(value[push.channel]) : value.rgb;
}

// Place in the texture of the pixel at `at` in the rectangle: its height is `tiles` textures, its width as many as fit.
vec2 place_of(ivec2 at) { return (vec2(at) + 0.5) * (push.tiles / float(push.rectangle.w)); }

bool outside(ivec2 at) { return any(greaterThanEqual(at, push.rectangle.zw)); }

void show(ivec2 at, vec3 color) { imageStore(target, push.rectangle.xy + at, vec4(color, 1.0)); }

#endif
