// What a pixel sees of the sun's disc. Pure functions, also valid C++; radians, km.
//
// A pixel is a rectangle of the image plane, and its value the mean of the light over that rectangle: a disc smaller
// than a pixel then sends the picture the same light wherever it falls, and pictures of every size agree. A single ray
// through the pixel's centre would either miss such a disc or count it as filling the pixel.
//
// In a plane at distance 1 in front of the eye the disc of angular radius a around s = (x, y, z), z forward, is an
// ellipse:
//   centre (x, y) z / q          q = z^2 - sin^2 a  (> 0: the disc lies wholly in front)
//   half height  b = sin a sqrt(cos^2 a - x^2) / q
//   its row at v half heights has the middle x y b v / (cos^2 a - x^2) and the half width sqrt(1 - v^2) c,
//   c = sin a cos a / sqrt(q (cos^2 a - x^2)).
// With u in units of c along a row and v in units of b, it is the unit circle, and mu_s, the cosine at the sun's
// surface, is exactly
//   mu_s^2 = (1 - u^2 - v^2) cos^2 a / (q |P|^2),      P the point of the plane, |P|^2 = 1 + X^2 + Y^2.
// Steps are equal in p and t with v = p sqrt(2 - p^2), u = w t sqrt(2 - t^2), w = sqrt(1 - v^2) = 1 - p^2 half a row's
// width. Then sqrt(1 - u^2 - v^2) = (1 - p^2)(1 - t^2), so that light that fades towards the limb is smooth in p and t.
#ifndef WELKIN_SUN_IN_PIXEL_GLSL
#define WELKIN_SUN_IN_PIXEL_GLSL

#include "interop/camera.h"
#include "03_planet_and_rays/ray_sphere.glsl"
#include "04_air/phase.glsl"

// [sun_in_pixel]
// The disc in the image plane, and a pixel's rectangle in half widths and half heights of it.
struct SunInPixel {
  int side;       // side^2 nodes; 0: the pixel sees nothing of the disc
  vec3 centre;    // of the ellipse, from the eye, in the camera's local frame
  vec3 along_u;   // half a width
  vec3 along_v;   // half a height, and what a row is shifted by
  float shift;    // of a row at v = 1, in half widths
  vec2 low;       // (u, v) of the rectangle's corners
  vec2 high;
  float per_pixel;  // area of (u, v) in pixels
  float mu_scale;   // cos a / sqrt(q)
};

// sin^2 as a series (next term 3e-3 a^8): Vulkan lets sin() be wrong by 5e-4 in absolute terms, and a real GPU's is off
// by 1e-4 of so small an angle, which shows at the limb.
float sine_squared(float angle) {
  float a2 = angle * angle;
  return a2 * (1.0 - a2 * (0.33333333333333333 - a2 * 0.044444444444444444));
}

// view: camera_direction() of that pixel. Domain: 0 < angular_radius <= 0.2. No disc is seen that reaches behind the eye.
SunInPixel sun_in_pixel(CameraRays camera, ivec2 pixel, vec3 view, float angular_radius) {
  SunInPixel disc;
  disc.side = 0;
  vec2 half_plane = vec2(length(camera.right), length(camera.up));
  vec2 half_pixel = half_plane / vec2(float(camera.size.x), float(camera.size.y));
  // Almost every pixel returns here: no point of it is further from its centre than half_pixel.x + half_pixel.y.
  float reach = angular_radius + half_pixel.x + half_pixel.y;
  if (2.0 * one_minus_cosine(view, camera.sun) > reach * reach) return disc;

  vec3 right = camera.right / half_plane.x;
  vec3 up = camera.up / half_plane.y;
  float x = dot(camera.sun, right);
  float y = dot(camera.sun, up);
  float z = dot(camera.sun, camera.forward);
  float sine2 = sine_squared(angular_radius);
  float q = z * z - sine2;
  if (z <= 0.0 || q < 0.01 * sine2) return disc;
  float cosine2 = 1.0 - sine2;
  float across2 = cosine2 - x * x;
  float half_height = sqrt(sine2 * across2) / q;
  float half_width = sqrt(sine2 * cosine2 / (q * across2));
  vec2 size = vec2(half_width, half_height);
  vec2 middle = vec2(x, y) * (z / q);
  disc.centre = camera.forward + right * middle.x + up * middle.y;
  disc.shift = x * y / across2 * half_height / half_width;
  disc.along_u = right * half_width;
  disc.along_v = up * half_height + disc.along_u * disc.shift;
  vec2 corner = vec2(float(2 * pixel.x - camera.size.x), float(camera.size.y - 2 * pixel.y - 2)) * half_pixel;
  disc.low = (corner - middle) / size;
  disc.high = (corner + half_pixel * 2.0 - middle) / size;
  disc.per_pixel = size.x * size.y / (4.0 * half_pixel.x * half_pixel.y);
  disc.mu_scale = sqrt(cosine2 / q);
  vec2 wide = disc.high - disc.low;
  // Keeps only rows that meet both the circle and the rectangle.
  disc.low.y = max(disc.low.y, -1.0);
  disc.high.y = min(disc.high.y, 1.0);
  vec2 moved = vec2(min(disc.shift * disc.low.y, disc.shift * disc.high.y),
                    max(disc.shift * disc.low.y, disc.shift * disc.high.y));
  float nearest_u = max(max(disc.low.x - moved.y, moved.x - disc.high.x), 0.0);
  if (disc.low.y >= disc.high.y || nearest_u >= 1.0) return disc;
  float tallest = sqrt((1.0 - nearest_u) * (1.0 + nearest_u));
  disc.low.y = max(disc.low.y, -tallest);
  disc.high.y = min(disc.high.y, tallest);
  if (disc.low.y >= disc.high.y) return disc;
  // Steps of an eighth of the radius: 12 where the whole disc is smaller than the pixel, 2 where it is large.
  disc.side = clamp(int(ceil(8.0 * max(wide.x, wide.y))), 2, 12);
  return disc;
}
// [/sun_in_pixel]

// [sun_node]
struct SunNode {
  vec3 view;    // unit, towards a piece of the disc in the pixel
  float share;  // of the pixel that this piece covers
  float mu;     // cosine at the sun's surface there
};

// p of v = p sqrt(2 - p^2), and how v grows with it.
float to_steps(float v) { return v / sqrt(1.0 + sqrt(max(1.0 - v * v, 0.0))); }
float from_steps(float p) { return p * sqrt(2.0 - p * p); }
float step_width(float p) { return 2.0 * (1.0 - p * p) / sqrt(2.0 - p * p); }

// A row of nodes: those at one v.
struct SunRow {
  float v;
  float height;     // in v
  float half_width; // w
  float t_begin;
  float t_step;
};

SunRow sun_row(SunInPixel disc, int i) {
  float begin = to_steps(disc.low.y);
  float p_step = (to_steps(disc.high.y) - begin) / float(disc.side);
  float p = begin + p_step * (float(i) + 0.5);
  SunRow row;
  row.v = from_steps(p);
  row.height = step_width(p) * p_step;
  row.half_width = max(1.0 - p * p, 1.0e-6);
  row.t_begin = to_steps(clamp((disc.low.x - disc.shift * row.v) / row.half_width, -1.0, 1.0));
  row.t_step = (to_steps(clamp((disc.high.x - disc.shift * row.v) / row.half_width, -1.0, 1.0)) - row.t_begin) /
               float(disc.side);
  return row;
}

// Node j of a row. horizon: cosine and sine of its zenith angle, horizon_at(); what lies below it is not seen.
SunNode sun_node(SunInPixel disc, SunRow row, vec2 horizon, int j) {
  float t = row.t_begin + row.t_step * (float(j) + 0.5);
  float across = from_steps(t);
  float width = row.half_width * step_width(t) * row.t_step;
  float from_limb = row.half_width * (1.0 - t * t);  // sqrt(1 - u^2 - v^2)
  vec3 point = disc.centre + disc.along_u * (row.half_width * across) + disc.along_v * row.v;
  float nearness = 1.0 / length(point);
  SunNode node;
  node.view = point * nearness;
  node.mu = min(from_limb * disc.mu_scale * nearness, 1.0);
  node.share = max(width, 0.0) * row.height * disc.per_pixel;
  // The horizon cuts the node's piece: the part above it counts, seen from its middle. up: unit, away from the horizon.
  float sine = max(sqrt(node.view.x * node.view.x + node.view.y * node.view.y), 1.0e-20);
  float lean = -horizon.x / sine;
  vec3 up = vec3(node.view.x * lean, node.view.y * lean, horizon.y);
  float above = dot(up, node.view);
  // Pieces lean, since rows get shorter towards the limb: u = w across, and dw / dv = -v / w.
  float lean_u = -row.v * across / row.half_width;
  float height = (abs(dot(up, disc.along_u)) * width +
                  abs(dot(up, disc.along_v + disc.along_u * lean_u)) * row.height) * nearness;
  float seen = clamp(above + 0.5 * height, 0.0, height);
  if (seen < height) {
    node.share *= seen / height;
    vec3 raised_view = node.view + up * (0.5 * seen - above);
    node.view = raised_view / length(raised_view);
  }
  return node;
}
// [/sun_node]

#endif
