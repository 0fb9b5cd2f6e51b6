// Counts frames in an image: last frame's count plus one, or 1 where there is no last frame.
#version 460
#extension GL_GOOGLE_include_directive : require
layout(local_size_x = 8, local_size_y = 8) in;
#include "interop/view_block.glsl"
layout(binding = 0, rgba32f) uniform readonly image2D before;
layout(binding = 1, rgba32f) uniform writeonly image2D now;
layout(push_constant) uniform Push {
  int valid;
};

void main() {
  const ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(pixel, imageSize(now)))) return;
  const float count = valid == 1 ? imageLoad(before, pixel).r : 0.0;
  imageStore(now, pixel, vec4(count + 1.0, frame.cut, frame.last_camera.altitude_km, frame.camera.altitude_km));
}
