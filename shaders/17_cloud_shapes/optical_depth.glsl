// How much cloud a ray crosses. Pure functions, also valid C++; optical depths without unit, km.
//
//   tau = sum over bodies of  extinction * integral of density dt,      T = e^-tau
// Of a layer, a disc and a sphere the integral is the length of the ray's spans. Of a grid it is exact, too: in a cell
// the density is a cubic along the ray, which two Gauss points integrate. Of noise it is marched by the midpoint rule.
#ifndef WELKIN_CLOUD_OPTICAL_DEPTH_GLSL
#define WELKIN_CLOUD_OPTICAL_DEPTH_GLSL

#include "17_cloud_shapes/density.glsl"
#include "17_cloud_shapes/spans.glsl"

// Knobs cloud.steps, cloud.detail, cloud.grid; and where in its segment a sample lies, 0.5 unless a pixel moves it.
struct CloudMarch {
  int steps;
  int detail;
  int grid_method;
  int grid_steps;  // of kGridFiltered: a cell
  float offset;
};

// [point_along]
CloudPoint point_along(CloudRay ray, float ground_radius_km, float t_km) {
  CloudPoint point;
  point.origin_km = ray.origin_km;
  point.offset_km = ray.rest_km + ray.direction * t_km;
  point.altitude_km = altitude_along(ground_radius_km, ray.altitude_km, ray.mu, t_km);
  return point;
}
// [/point_along]

// [cells]
// Exact, cell by cell: the next face is found from the cell's number, so that rounding is not added up.
float grid_column_exact(CloudBody body, CloudRay ray, vec2 span) {
  vec3 from = start_from(ray, body.place_km);
  vec3 count = vec3(float(body.samples_x - 1), float(body.samples_y - 1), float(body.samples_z - 1));
  vec3 start = vec3(from.x / body.axis.x * count.x, from.y / body.axis.y * count.y, from.z / body.axis.z * count.z);
  vec3 slope = vec3(ray.direction.x / body.axis.x * count.x, ray.direction.y / body.axis.y * count.y, ray.direction.z / body.axis.z * count.z);
  vec3 entry = start + slope * span.x;
  vec3 cell = vec3(0.0, 0.0, 0.0);
  for (int axis = 0; axis < 3; axis++) cell[axis] = clamp(floor(entry[axis]), 0.0, count[axis] - 1.0);
  float sum = 0.0, t = span.x;
  int most = body.samples_x + body.samples_y + body.samples_z;
  for (int visit = 0; visit < most && t < span.y; visit++) {
    float leave = span.y;
    int next_axis = -1;
    for (int axis = 0; axis < 3; axis++) {
      if (abs(slope[axis]) < 1.0e-12) continue;
      float face = (cell[axis] + (slope[axis] > 0.0 ? 1.0 : 0.0) - start[axis]) / slope[axis];
      if (face < leave) {
        leave = face;
        next_axis = axis;
      }
    }
    float dt = leave - t;
    if (dt > 0.0) {
      for (int node = 0; node < 2; node++) {
        vec3 at = start + slope * (t + dt * (node == 0 ? 0.21132486540518713 : 0.78867513459481287));
        vec3 way = vec3(clamp(at.x / count.x, 0.0, 1.0), clamp(at.y / count.y, 0.0, 1.0), clamp(at.z / count.z, 0.0, 1.0));
        sum += 0.5 * dt * grid_density(body, way, kGridExact);
      }
      t = leave;
    }
    if (next_axis < 0) break;
    cell[next_axis] += slope[next_axis] > 0.0 ? 1.0 : -1.0;
    if (cell[next_axis] < 0.0 || cell[next_axis] >= count[next_axis]) break;
  }
  return sum;
}
// [/cells]

// [steps]
// Steps for a span. Of noise `steps` across the body's thickness, so that a step is as long for every ray; a span more
// than eight times as long takes longer ones. Of a grid grid_steps for the shortest edge
// of a cell; 4096 at most: longer columns take longer steps.
int march_steps(CloudBody body, float length_km, CloudMarch march) {
  if (body.kind != kCloudGrid)
    return clamp(int(ceil(float(march.steps) * length_km / (body.top_km - body.base_km))), 1, 8 * march.steps);
  float cell_km = min(min(body.axis.x / float(body.samples_x - 1), body.axis.y / float(body.samples_y - 1)), body.axis.z / float(body.samples_z - 1));
  return clamp(int(ceil(float(march.grid_steps) * length_km / cell_km)), 1, 4096);
}
// [/steps]

// [marched]
// By the midpoint rule. x: integral of the density over a span, km; and what is needed to paint a picture, y: the share of
// light that stops, z: the same weighted by the relative height where it does, w: by the distance.
vec4 marched_column(CloudBody body, float ground_radius_km, CloudRay ray, vec2 span, CloudMarch march) {
  vec4 sum = vec4(0.0, 0.0, 0.0, 0.0);
  float length_km = span_length(span);
  if (length_km <= 0.0) return sum;
  int steps = march_steps(body, length_km, march);
  float dt = length_km / float(steps), before = 1.0;
  for (int i = 0; i < steps; i++) {
    float t = span.x + (float(i) + march.offset) * dt;
    CloudPoint point = point_along(ray, ground_radius_km, t);
    float density = cloud_density(body, ground_radius_km, point, march.detail, march.grid_method);
    if (density > 0.0) {
      sum.x += density * dt;
      float after = exp(-body.extinction_per_km * sum.x);
      sum.y += before - after;
      sum.z += (before - after) * (point.altitude_km - body.base_km) / (body.top_km - body.base_km);
      sum.w += (before - after) * t;
      before = after;
    }
  }
  return sum;
}
// [/marched]

// [optical_depth]
// Of one body along a ray.
float body_optical_depth(CloudBody body, float ground_radius_km, CloudRay ray, CloudMarch march) {
  Spans spans = body_spans(body, ground_radius_km, ray);
  float column = 0.0;
  bool grid = (CLOUD_KINDS & kCloudGrid) != 0 && body.kind == kCloudGrid;
  if (grid && march.grid_method == kGridExact) {
    if (span_length(spans.first) > 0.0) column = grid_column_exact(body, ray, spans.first);
  } else if (grid || ((CLOUD_KINDS & kCloudNoise) != 0 && body.kind == kCloudNoise)) {
    column = marched_column(body, ground_radius_km, ray, spans.first, march).x + marched_column(body, ground_radius_km, ray, spans.second, march).x;
  } else {
    column = spans_length(spans);
  }
  return body.extinction_per_km * column;
}
// [/optical_depth]

#endif
