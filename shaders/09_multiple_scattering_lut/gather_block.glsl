// Shared by the entry points that gather light: the numbers of directions and nodes, the buffer of nodes, and the point
// of a texel.
#ifndef WELKIN_GATHER_BLOCK_GLSL
#define WELKIN_GATHER_BLOCK_GLSL

layout(constant_id = 7) const int DIRECTIONS = 32;
layout(constant_id = 8) const int DIRECTION_SET = 0;
layout(constant_id = 9) const int STEPS = 8;  // nodes of a ray

#ifdef NODES_ARE_WRITTEN
layout(binding = 4, std430) writeonly buffer Nodes {
#else
layout(binding = 4, std430) readonly buffer Nodes {
#endif
  RayNode nodes[];  // [altitude][zenith angle][STEPS + 1]: a ray's STEPS nodes, then its end
};

int first_node_of(int row, int direction) {
  return (row * zenith_angles_of_set(DIRECTION_SET, DIRECTIONS) +
          zenith_angle_index(DIRECTION_SET, direction, DIRECTIONS)) * (STEPS + 1);
}

// The point of a texel: x: mu_sun, y: altitude.
vec2 texel_point(ivec2 texel) {
  return table_point(MS_MAP, atmosphere.top_km, table_unit_of_texel(vec2(texel), float(MS_SIZE)));
}

#endif
