// Quadrature nodes of the rays that light is gathered along. The nodes' places, and the fraction of the light scattered
// there that reaches the ray's first point, depend only on that point's altitude and the ray's zenith angle. They are
// computed once and used for all sun zenith angles, azimuths and orders. Pure functions; km.
//   gathered radiance = sum over nodes of (w_R P_R + w_M P_M) * incident light,     weights w = T beta rho dt
// T: transmittance to the first point; beta rho: scattering coefficient; P: phase function; R: Rayleigh, M: Mie.
#ifndef WELKIN_RAY_NODES_GLSL
#define WELKIN_RAY_NODES_GLSL

#include "09_multiple_scattering_lut/source_march.glsl"

// [ray_node]
struct RayNode {
  vec4 geometry;  // x: altitude; y: r / r', z: t / r'; r, r': radii of the ray's first point and of the node
  vec4 rayleigh;  // weights w_R per channel
  vec4 mie;       // weights w_M
};

// The zenith cosine mu of a direction at the ray's first point, at the node: mu' = (r mu + t nu) / r'. nu: cosine
// between direction and ray.
float cosine_at_node(RayNode node, float mu, float nu) {
  return clamp(node.geometry.y * mu + node.geometry.z * nu, -1.0, 1.0);
}

RayNode node_at(Atmosphere atmosphere, AirRay ray, float altitude_km, float t_km) {
  float r = atmosphere.ground_radius_km + altitude_km;
  RayNode node;
  node.geometry = vec4(altitude_km, (atmosphere.ground_radius_km + ray.altitude_km) / r, t_km / r, 0.0);
  node.rayleigh = vec4(0.0, 0.0, 0.0, 0.0);
  node.mie = vec4(0.0, 0.0, 0.0, 0.0);
  return node;
}

// The end of the ray. `rayleigh` holds the weight of light reflected by the ground there, T albedo; 0 if the ray leaves
// the air.
RayNode ray_end(Atmosphere atmosphere, SourceRay along) {
  RayNode node = node_at(atmosphere, along.ray, 0.0, along.ray.length_km);
  if (along.ray.hits_air && along.ray.hits_ground)
    node.rayleigh = vec4(ray_transmittance(atmosphere, along) * atmosphere.ground_albedo, 0.0);
  return node;
}
// [/ray_node]

// Cells of equal count (see ScaleCount of chapter 05), and the weight by which nodes are distributed over them.
struct NodeCells {
  float width;
  float total;
  float weight[kSourceCells];
};

// [node_cells]
// A cell's weight follows the light it scatters to the ray's first point, T sigma_s per count, with a minimum wherever
// there is air: at dusk only a dim cell may be lit.
NodeCells node_cells(Atmosphere atmosphere, SourceRay along) {
  NodeCells cells;
  cells.width = (along.x_end - along.x_begin) / float(kSourceCells);
  cells.total = 0.0;
  vec4 estimate[kSourceCells];  // xyz: T sigma_s; w: change of the largest optical depth per count
  float tau_before = 0.0;
  vec3 peak = vec3(1.0e-37, 1.0e-37, 1.0e-37);
  vec3 column = vec3(0.0, 0.0, 0.0);
  for (int j = 0; j < kSourceCells; j++) {
    CountedPoint point =
        point_at_count(along.count, along.ray, along.line, along.x_begin + cells.width * (float(j) + 0.5));
    vec3 air = densities(atmosphere, point.altitude_km) * point.dt_dx;
    vec3 depth = extinction(atmosphere, column + air * (0.5 * cells.width));
    vec3 light = (atmosphere.rayleigh_scattering * air.x + atmosphere.mie_scattering * air.y) * exp(-depth);
    float tau = max(max(depth.x, depth.y), depth.z);
    estimate[j] = vec4(light, abs(tau - tau_before) / cells.width);
    tau_before = tau;
    column += air * cells.width;
    peak = max(peak, light);
  }
  for (int j = 0; j < kSourceCells; j++) {
    cells.weight[j] = cell_weight(vec3(estimate[j]) / peak, estimate[j].w, 1.0);
    cells.total += cells.weight[j];
  }
  return cells;
}

// Count at which the first n of `panels` panels end.
float panel_end(SourceRay along, NodeCells cells, int n, int panels) {
  float target = cells.total * float(n) / float(panels);
  float summed = 0.0;
  for (int j = 0; j < kSourceCells; j++) {
    float fraction = (target - summed) / cells.weight[j];
    if (fraction <= 1.0) return min(along.x_begin + cells.width * (float(j) + fraction), along.x_end);
    summed += cells.weight[j];
  }
  return along.x_end;
}
// [/node_cells]

struct NodePanel {
  RayNode node[4];
};

// [panel_nodes]
// Panel number `panel` (from 0) of a ray's `panels`: four Gauss nodes, with columns up to each as in chapter 05's
// panels.
NodePanel panel_nodes(Atmosphere atmosphere, SourceRay along, int panel, int panels) {
  NodeCells cells = node_cells(atmosphere, along);
  float x_a = panel_end(along, cells, panel, panels);
  float dx = panel_end(along, cells, panel + 1, panels) - x_a;
  vec3 before = panel > 0 ? columns_to_count(atmosphere, along.ray, along.line, along.count, x_a) : vec3(0.0, 0.0, 0.0);
  float ozone_begin = ozone_from_tangent(atmosphere, along.line, along.ray.altitude_km,
                                         (atmosphere.ground_radius_km + along.ray.altitude_km) * along.ray.mu);
  NodePanel result;
  vec4 rayleigh;
  vec4 mie;
  vec4 ozone;
  for (int i = 0; i < 4; i++) {
    CountedPoint point = point_at_count(along.count, along.ray, along.line, x_a + dx * kGauss4Node[i]);
    vec3 air = densities(atmosphere, point.altitude_km) * (point.dt_dx * dx);
    rayleigh[i] = air.x;
    mie[i] = air.y;
    ozone[i] = ozone_from_tangent(atmosphere, along.line, point.altitude_km, point.s_km);
    result.node[i] = node_at(atmosphere, along.ray, point.altitude_km, point.t_km);
  }
  if (!along.ray.hits_air || along.x_end <= along.x_begin) return result;
  vec2 summed = vec2(0.0, 0.0);
  float summed_width = 0.0;
  for (int i = 0; i < 4; i++) {
    vec2 air = vec2(rayleigh[i], mie[i]);
    vec2 inside = column_inside(rayleigh, mie, i, (summed + air * (kGauss4Node[i] - summed_width)) * 0.5);
    summed += air * kGauss4Weight[i];
    summed_width += kGauss4Weight[i];
    vec3 column = vec3(before.x + inside.x, before.y + inside.y, ozone[i] - ozone_begin);
    vec3 weighted_transmittance = exp(-extinction(atmosphere, column)) * kGauss4Weight[i];
    result.node[i].rayleigh = vec4(atmosphere.rayleigh_scattering * air.x * weighted_transmittance, 0.0);
    result.node[i].mie = vec4(atmosphere.mie_scattering * air.y * weighted_transmittance, 0.0);
  }
  return result;
}
// [/panel_nodes]

#endif
