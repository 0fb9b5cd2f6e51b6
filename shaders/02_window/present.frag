// The displayed picture, texel for pixel: what the window shows is bit for bit what a headless run writes.
#version 460
layout(binding = 0, rgba8) uniform readonly image2D displayed;
layout(location = 0) out vec4 colour;
void main() {
  const ivec2 pixel = min(ivec2(gl_FragCoord.xy), imageSize(displayed) - 1);
  colour = imageLoad(displayed, pixel);
}
