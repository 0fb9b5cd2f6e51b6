// The height map as a surface, what a ray meets of it, and how high its shadow reaches. Pure functions; km, global
// frame. The including file gives
//   vec4 patch_corners(ivec2 cell)            heights at a patch's corners: (0, 0), (1, 0), (0, 1), (1, 1)
//   float highest_in(ivec2 node, int level)   highest corner of 2^level x 2^level patches; level 1 and above
//
// Grid coordinates count samples: `grid` is (column, row) + 1, so that patch (i, j) is the square between samples i - 1
// and i, j - 1 and j. Inside it the surface is bilinear; the map's outer half samples are level. size + 1 patches a
// side. Both walks below follow a line from node to node of a tree of maxima. A line that stays above a node's highest
// point passes the node in one step, however large it is; otherwise the walk looks at the node's parts. In a patch the
// bilinear surface along a line is a parabola, so that the result is exact at any distance and for the narrowest crest.
// Tevs 2008, "Maximum mipmaps".
#ifndef WELKIN_HEIGHT_FIELD_GLSL
#define WELKIN_HEIGHT_FIELD_GLSL

#include "03_planet_and_rays/ray_sphere.glsl"
#include "11_aerial_perspective/terrain.glsl"

const int kMostVisits = 512;         // nodes that one walk may look at; measured: fewer than 200
const float kBeyondEdge = 1.0e-3;    // of a patch: how far a step goes beyond the border it leads to
const float kDrowned_km = 1.0e-4;    // a ray outside of the map this far below the sphere has met it, despite rounding

struct HeightField {
  float ground_radius_km;
  float extent_km;
  float highest_km;
  int size;    // samples a side
  int levels;  // of the tree; a node of the last is 2^levels patches wide
};

vec2 grid_at(HeightField field, vec2 place_km) {
  float n = float(field.size);
  return vec2((place_km.x / field.extent_km + 0.5) * n + 0.5, (0.5 - place_km.y / field.extent_km) * n + 0.5);
}

// [patch_along]
// The surface from in_patch to in_patch + delta, both inside one patch: c.x + c.y s + c.z s^2, s = 0 ... 1.
vec3 patch_along(vec4 corners, vec2 in_patch, vec2 delta) {
  float across = corners.y - corners.x;
  float down = corners.z - corners.x;
  float twist = corners.w - corners.z - across;
  return vec3(corners.x + across * in_patch.x + down * in_patch.y + twist * in_patch.x * in_patch.y,
              across * delta.x + down * delta.y + twist * (in_patch.x * delta.y + in_patch.y * delta.x),
              twist * delta.x * delta.y);
}

// First s in 0 ... 1 where c.x + c.y s + c.z s^2, above 0 at s = 0, comes down to 0; below 0 if it does not.
float first_root(vec3 c) {
  if (c.x <= 0.0) return 0.0;
  float discriminant = c.y * c.y - 4.0 * c.z * c.x;
  if (discriminant < 0.0) return -1.0;
  float below = sqrt(discriminant) - c.y;
  float s = below > 0.0 ? 2.0 * c.x / below : -1.0;
  return s <= 1.0 ? s : -1.0;
}
// [/patch_along]

// How many steps of `rate` lead from a place between two borders to the border ahead. Where that is nearer than
// kBeyondEdge, it counts as that far away: a line along a border would otherwise never move on.
float steps_between(float at, float low, float high, float rate) {
  float room = rate > 0.0 ? high - at : at - low;
  return (room < kBeyondEdge ? kBeyondEdge : room) / max(abs(rate), 1.0e-9);
}

// How far a line may go before it leaves a node, or the map.
float steps_to_border(HeightField field, vec2 grid, vec2 rate, ivec2 node, int level) {
  float end = float(field.size) + 0.5;
  float across =
      steps_between(grid.x, max(float(node.x << level), 0.5), min(float((node.x + 1) << level), end), rate.x);
  float down = steps_between(grid.y, max(float(node.y << level), 0.5), min(float((node.y + 1) << level), end), rate.y);
  return min(across, down);
}

// [first_hit]
// What a ray meets. An edge is a crest that it passes so closely that the pixel shows some of it.
struct Hit {
  float t_km;       // of the terrain, below 0: none
  float approach;   // by how much the ray comes nearer to the surface per km, where it meets it
  float edge_km;    // of the edge before it that covers most of the pixel
  float edge_share; // of the pixel that the edge covers, 0: none
  int visits;       // nodes that were looked at
};

// Where a ray first meets the terrain, unless it meets the sphere outside of the map before. The ray starts at
// start_km, begins_km from the eye and altitude_km above the sphere; mu: its cosine to the vertical there; pixel: width
// of a pixel at a distance of 1. Along the ray the altitude bends up, as the ground falls away; the speed of the ray's
// place on the map hardly changes over a node.
Hit first_hit(HeightField field, vec3 start_km, vec3 direction, float altitude_km, float mu, float begins_km,
              float pixel) {
  Hit hit;
  hit.t_km = -1.0;
  hit.approach = 1.0;
  hit.edge_km = -1.0;
  hit.edge_share = 0.0;
  float radius = field.ground_radius_km;
  float nearest_km = -(radius + altitude_km) * mu;  // along the ray, to the centre
  float t = 0.0;
  int level = 0;
  for (hit.visits = 0; hit.visits < kMostVisits; hit.visits++) {
    float altitude = altitude_along(radius, altitude_km, mu, t);
    float half_pixel_km = 0.5 * (begins_km + t) * pixel;
    if (altitude > field.highest_km + half_pixel_km && t >= nearest_km) return hit;
    float scale = radius / (radius + altitude);
    vec2 place = vec2((start_km.x + direction.x * t) * scale, (start_km.y + direction.y * t) * scale);
    float climb = (t - nearest_km) / (radius + altitude);  // of altitude, per km
    vec2 speed = vec2(direction.x - place.x * climb / radius, direction.y - place.y * climb / radius) * scale;
    float outside_map_km = max(abs(place.x), abs(place.y)) - 0.5 * field.extent_km;
    float patch_km = field.extent_km / float(field.size);
    float beyond = -radius - (start_km.z + direction.z * t);  // the half of the planet that the map is not on
    if (outside_map_km > 0.0 || beyond > 0.0) {
      float to_map_km = outside_map_km > 0.0 ? outside_map_km / max(max(abs(speed.x), abs(speed.y)), 1.0e-6) : 0.0;
      float step_km = max(max(to_map_km, beyond), kBeyondEdge * patch_km);  // at most as far as the edge of the map
      float lowest = altitude_along(radius, altitude_km, mu, clamp(nearest_km, t, t + step_km));
      if (lowest < -kDrowned_km) return hit;
      t += step_km;
      continue;
    }
    vec2 grid = grid_at(field, place);
    vec2 rate = vec2(speed.x, -speed.y) / patch_km;
    // [pass_or_split]
    ivec2 node = ivec2(int(grid.x) >> level, int(grid.y) >> level);
    float dt = steps_to_border(field, grid, rate, node, level);
    float altitude_end = altitude_along(radius, altitude_km, mu, t + dt);
    if (level > 0) {
      float lowest = min(altitude, altitude_end);
      if (t < nearest_km && nearest_km < t + dt) lowest = altitude_along(radius, altitude_km, mu, nearest_km);
      if (lowest <= highest_in(node, level) + half_pixel_km) {
        level--;
        continue;
      }
    } else {
      vec3 surface = patch_along(patch_corners(node), vec2(grid.x - float(node.x), grid.y - float(node.y)), rate * dt);
      float bend = 2.0 * (altitude - 2.0 * altitude_along(radius, altitude_km, mu, t + 0.5 * dt) + altitude_end);
      vec3 over = vec3(altitude, altitude_end - altitude - bend, bend) - surface;
      float s = first_root(over);
      if (s >= 0.0) {
        hit.t_km = t + s * dt;
        hit.approach = -(over.y + 2.0 * over.z * s) / max(dt, 1.0e-9);
        return hit;
      }
      // [/pass_or_split]
      // An edge: where the ray comes nearest to the patch before it rises again. At a clearance of 0 it covers half a
      // pixel.
      float near = over.z > 0.0 ? clamp(-0.5 * over.y / over.z, 0.0, 1.0) : (over.y + over.z < 0.0 ? 1.0 : 0.0);
      float height = over.x + near * (over.y + near * over.z);
      float covered = 0.5 - 0.5 * height / max(half_pixel_km, 1.0e-9);
      if (near < 1.0 && covered > hit.edge_share) {
        hit.edge_share = covered;
        hit.edge_km = t + near * dt;
      }
    }
    dt += kBeyondEdge / max(max(abs(rate.x), abs(rate.y)), 1.0e-3);
    level = min(level + 1, field.levels);
    t += dt;
  }
  return hit;
}
// [/first_hit]

// [shadow_over]
// x: the altitude above a place from which the sun's centre is seen past all terrain that lies start_km or more towards
// the sun: the largest shadow_altitude() of the surface's points. y: the distance to that point. `towards`: unit vector
// on the map. Inside a node no point can exceed the node's highest point at its nearest distance, or where a sunray
// from below the horizontal is lowest.
vec2 shadow_over(HeightField field, vec2 place_km, vec2 towards, float tan_elevation, float start_km, out int visits) {
  float patch_km = field.extent_km / float(field.size);
  vec2 from = grid_at(field, place_km);
  vec2 rate = vec2(towards.x, -towards.y) / patch_km;
  float lowest_km = max(-field.ground_radius_km * tan_elevation, 0.0);  // along the way, of the sunray
  vec2 best = vec2(-1.0e3, start_km);
  float s = start_km;
  int level = 0;
  for (visits = 0; visits < kMostVisits; visits++) {
    vec2 grid = from + rate * s;
    float n = float(field.size) + 0.5;
    if (grid.x < 0.5 || grid.y < 0.5 || grid.x > n || grid.y > n) break;
    if (shadow_altitude(field.ground_radius_km, field.highest_km, max(s, lowest_km), tan_elevation) <= best.x) break;
    ivec2 node = ivec2(int(grid.x) >> level, int(grid.y) >> level);
    float ds = steps_to_border(field, grid, rate, node, level);
    if (level > 0) {
      float nearest = clamp(lowest_km, s, s + ds);
      if (shadow_altitude(field.ground_radius_km, highest_in(node, level), nearest, tan_elevation) > best.x) {
        level--;
        continue;
      }
    } else {
      // Surface minus sunray is a parabola: largest at an end, or at its top.
      vec3 c = patch_along(patch_corners(node), vec2(grid.x - float(node.x), grid.y - float(node.y)), rate * ds);
      c.x = shadow_altitude(field.ground_radius_km, c.x, s, tan_elevation);
      c.y -= ds * (tan_elevation + s / field.ground_radius_km);
      c.z -= ds * ds / (2.0 * field.ground_radius_km);
      float top = c.z < 0.0 ? clamp(-0.5 * c.y / c.z, 0.0, 1.0) : (c.y + c.z > 0.0 ? 1.0 : 0.0);
      float altitude = c.x + top * (c.y + top * c.z);
      if (altitude > best.x) best = vec2(altitude, s + top * ds);
    }
    ds += kBeyondEdge / max(max(abs(rate.x), abs(rate.y)), 1.0e-3);
    level = min(level + 1, field.levels);
    s += ds;
  }
  return best;
}
// [/shadow_over]

#endif
