// Flights of light through bodies of cloud: to the first collision, and the share that comes through. Pure functions; km, 1/km.
//
// A body's extinction is bounded along a ray, piece by piece: exactly by itself where the body is homogeneous, by the largest
// sample of a coarse cell in a grid, by its largest density in noise. Tentative collisions come at the bound's rate; one is
// real with probability extinction / bound (Woodcock's delta tracking). Bodies do not know of each other: each has its own
// collisions, and the first of all counts.
//
// The including file gives what density.glsl of chapter 17 wants, and the grids' bounds:
//   float grid_bound(int i, int j, int k)   largest density of kBoundCells^3 cells of a grid; a grid's own begin at slice
//                                           first_slice / 2
#ifndef WELKIN_CLOUD_FLIGHT_GLSL
#define WELKIN_CLOUD_FLIGHT_GLSL

#include "07_ground_truth/flight.glsl"
#include "17_cloud_shapes/optical_depth.glsl"

const int kBoundCells = 4;

// [rays]
// A ray from a point of another one. The vertical there is the point's own; the altitude is carried along, not found again.
CloudRay cloud_ray_from(CloudPoint point, float ground_radius_km, vec3 direction) {
  vec3 from_axis = point.origin_km + point.offset_km;
  vec3 up = vec3(from_axis.x, from_axis.y, from_axis.z + ground_radius_km);
  up = up / length(up);
  CloudRay ray;
  ray.origin_km = point.origin_km;
  ray.rest_km = point.offset_km;
  ray.direction = direction;
  ray.altitude_km = point.altitude_km;
  ray.mu = clamp(dot(direction, up), -1.0, 1.0);
  ray.sine = min(length(direction - up * ray.mu), 1.0);
  ray.begins_km = 0.0;
  ray.end_km = ground_end(ground_radius_km, point.altitude_km, ray.mu, ray.sine);
  return ray;
}
// [/rays]

// [bounds]
// From t on the extinction of a body is below this, up to end_km.
struct Bound {
  float per_km;
  float end_km;
};

// One coarse cell of a grid. A ray on a face belongs to the cell it enters: the place is looked up a little ahead.
Bound grid_cell_bound(CloudBody body, CloudRay ray, float t_km, float leave_km) {
  vec3 from = start_from(ray, body.place_km);
  vec3 cells = vec3(float(body.samples_x - 1), float(body.samples_y - 1), float(body.samples_z - 1)) * (1.0 / float(kBoundCells));
  vec3 start = vec3(from.x / body.axis.x * cells.x, from.y / body.axis.y * cells.y, from.z / body.axis.z * cells.z);
  vec3 slope = vec3(ray.direction.x / body.axis.x * cells.x, ray.direction.y / body.axis.y * cells.y, ray.direction.z / body.axis.z * cells.z);
  float ahead_km = 1.0e-4 / max(max(max(abs(slope.x), abs(slope.y)), abs(slope.z)), 1.0e-6);
  vec3 place = start + slope * (t_km + ahead_km);
  Bound bound;
  bound.end_km = leave_km;
  vec3 cell = vec3(0.0, 0.0, 0.0);
  for (int axis = 0; axis < 3; axis++) {
    cell[axis] = clamp(floor(place[axis]), 0.0, ceil(cells[axis]) - 1.0);
    if (abs(slope[axis]) < 1.0e-9) continue;
    float face = (cell[axis] + (slope[axis] > 0.0 ? 1.0 : 0.0) - start[axis]) / slope[axis];
    bound.end_km = min(bound.end_km, face);
  }
  bound.end_km = min(max(bound.end_km, t_km + ahead_km), leave_km);
  bound.per_km = body.extinction_per_km * grid_bound(int(cell.x), int(cell.y), int(cell.z) + body.first_slice / 2);
  return bound;
}

Bound body_bound(CloudBody body, CloudRay ray, Spans spans, float t_km) {
  vec2 span = t_km < spans.first.y ? spans.first : spans.second;
  Bound bound;
  bound.per_km = 0.0;
  bound.end_km = kNoEnd_km;
  if (t_km >= span.y) return bound;  // beyond all of it
  bound.end_km = span.x;
  if (t_km < span.x) return bound;  // before it
  if (body.kind == kCloudGrid) return grid_cell_bound(body, ray, t_km, span.y);
  bound.per_km = body.extinction_per_km * body.largest_density;
  bound.end_km = span.y;
  return bound;
}

bool is_homogeneous(CloudBody body) { return body.kind != kCloudGrid && body.kind != kCloudNoise; }

// Integral of the bound over the ray: how many tentative collisions it has in the mean.
float bound_column(CloudBody body, CloudRay ray, Spans spans) {
  if (body.kind != kCloudGrid) return body.extinction_per_km * body.largest_density * spans_length(spans);
  float sum = 0.0;
  float t = 0.0;
  for (int i = 0; i < 2000 && t < ray.end_km; i++) {
    Bound bound = body_bound(body, ray, spans, t);
    if (bound.end_km >= kNoEnd_km) break;
    sum += bound.per_km * (bound.end_km - t);
    t = bound.end_km;
  }
  return sum;
}
// [/bounds]

// [cloud_flight]
struct CloudFlight {
  bool collided;
  bool finished;  // false: a loop ended before its flight
  float t_km;     // to the collision
  int body;       // with which
  float met;      // probability of what was forced on it (cloud_scene.glsl)
  Random random;
};

float real_share(CloudBody body, CloudRay ray, float ground_radius_km, float t_km, float bound_per_km, int detail) {
  CloudPoint point = point_along(ray, ground_radius_km, t_km);
  return body.extinction_per_km * cloud_density(body, ground_radius_km, point, detail, kGridExact) / max(bound_per_km, 1.0e-30);
}

// The collision at this optical depth of a homogeneous body: no loop.
CloudFlight flight_to_depth(CloudBody body, int number, Spans spans, float depth, CloudFlight flight) {
  float length_km = depth / body.extinction_per_km;
  float first_km = span_length(spans.first);
  float t = length_km < first_km ? spans.first.x + length_km : spans.second.x + (length_km - first_km);
  if (length_km >= spans_length(spans) || t >= flight.t_km) return flight;
  flight.collided = true;
  flight.t_km = t;
  flight.body = number;
  return flight;
}

// The first real collision with one body, before flight.t_km. `depth`: optical depth of the bound to the first tentative one.
CloudFlight flight_in_body(CloudBody body, int number, CloudRay ray, Spans spans, float ground_radius_km, float depth, int detail,
                           CloudFlight flight) {
  if (is_homogeneous(body)) return flight_to_depth(body, number, spans, depth, flight);
  float t = 0.0;
  for (int i = 0; i < 60000; i++) {
    if (t >= flight.t_km) return flight;
    Bound bound = body_bound(body, ray, spans, t);
    float end = min(bound.end_km, flight.t_km);
    float available = bound.per_km * (end - t);
    if (available <= depth) {
      depth -= available;
      t = end;
      continue;
    }
    t += depth / bound.per_km;
    flight.random = draw(flight.random);
    if (flight.random.value.x < real_share(body, ray, ground_radius_km, t, bound.per_km, detail)) {
      flight.collided = true;
      flight.t_km = t;
      flight.body = number;
      return flight;
    }
    depth = minus_log_one_minus(flight.random.value.y);
  }
  flight.finished = false;
  return flight;
}
// [/cloud_flight]

// [cloud_transmittance]
// Of one body by ratio tracking: a random number whose mean is exp(-tau). Where a body is homogeneous it is exp(-tau).
// What has become small goes on with a chance of its own size only.
struct TrackedTransmittance {
  float value;
  bool finished;
  Random random;
};

TrackedTransmittance through_body(CloudBody body, CloudRay ray, Spans spans, float ground_radius_km, int detail, TrackedTransmittance light) {
  if (is_homogeneous(body)) {
    light.value *= exp(-body.extinction_per_km * spans_length(spans));
    return light;
  }
  light.random = draw(light.random);
  float depth = minus_log_one_minus(light.random.value.x);
  float t = 0.0;
  for (int i = 0; i < 60000; i++) {
    if (t >= ray.end_km) return light;
    Bound bound = body_bound(body, ray, spans, t);
    if (bound.end_km >= kNoEnd_km) return light;
    float available = bound.per_km * (bound.end_km - t);
    if (available <= depth) {
      depth -= available;
      t = bound.end_km;
      continue;
    }
    t += depth / bound.per_km;
    light.value *= max(1.0 - real_share(body, ray, ground_radius_km, t, bound.per_km, detail), 0.0);
    light.random = draw(light.random);
    if (light.value < 0.1) {
      if (light.random.value.y * 0.1 >= light.value) {
        light.value = 0.0;
        return light;
      }
      light.value = 0.1;
    }
    depth = minus_log_one_minus(light.random.value.x);
  }
  light.finished = false;
  return light;
}
// [/cloud_transmittance]

#endif
