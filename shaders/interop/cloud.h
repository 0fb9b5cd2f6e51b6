// Bodies of cloud as shaders see them: the uniform block "Clouds". Included by C++ and by GLSL.
//
// km and 1/km. The global frame is the tangent frame of the scene's place: origin on the ground, x east, y north, z up;
// the planet's centre is at (0, 0, -R). Altitudes are above the ground. std140.
#ifndef WELKIN_INTEROP_CLOUD_H
#define WELKIN_INTEROP_CLOUD_H

#if defined(__cplusplus) && !defined(WELKIN_SHADER_TWIN)
#include <cstddef>
#include <glm/vec3.hpp>

namespace welkin::interop {
using vec3 = glm::vec3;
#endif

const int kMostCloudBodies = 64;  // kMostClouds of common/scene/scene.hpp

// Which bodies there are; a bit each in the specialization constant CLOUD_KINDS.
const int kCloudLayer = 1;
const int kCloudDisc = 2;
const int kCloudSphere = 4;
const int kCloudGrid = 8;
const int kCloudNoise = 16;

// [body]
struct CloudBody {
  int kind;
  float extinction_per_km;  // where density is 1
  float single_scattering_albedo;
  float largest_density;  // of the body: extinction_per_km times it bounds its extinction everywhere
  float base_km;          // layer, disc, noise
  float top_km;
  float radius_km;   // sphere; disc: radius at the base of the cone that cuts it out of the shell, (R + base) tan(angle)
  float cone_slope;  // disc: tan(angle)
  vec3 place_km;     // sphere: centre; grid: lowest corner; disc: where its axis meets the base
  float coverage;    // noise
  vec3 axis;         // disc: unit, up; grid: size in km
  float type;        // noise: 0 to 1, or -1: the weather map's
  int samples_x;     // grid: corners along each axis
  int samples_y;
  int samples_z;
  int first_slice;   // and where it begins in the texture that holds all grids, stacked along z
  float cell_km;     // noise: period of the base texture
  float extent_km;   // side of the weather's square
  float turn_x;      // and how seed turns (cosine, sine) and
  float turn_y;
  float shift_x;     // shifts it, in squares
  float shift_y;
  float lobe_weight;  // phase function: weight Draine(lobe_g, lobe_alpha) + (1 - weight) Draine(second_g, second_alpha)
  float lobe_g;
  float lobe_alpha;
  float second_g;
  float second_alpha;
  float painted;  // 1: the weather map is the user's: taken as it is
};

// [block]
struct CloudBlock {
  int count;
  float ground_radius_km;
  float ceiling_km;  // no body reaches higher: above the ground, altitude
  float floor_km;    // or lower
  int unused_0, unused_1, unused_2, unused_3;
  CloudBody bodies[kMostCloudBodies];
};
// [/block]
// [/body]

#if defined(__cplusplus) && !defined(WELKIN_SHADER_TWIN)
static_assert(sizeof(CloudBody) == 128 && sizeof(CloudBlock) == 32 + 64 * 128 && offsetof(CloudBlock, bodies) == 32);
static_assert(offsetof(CloudBody, base_km) == 16 && offsetof(CloudBody, cone_slope) == 28);
static_assert(offsetof(CloudBody, place_km) == 32 && offsetof(CloudBody, coverage) == 44);
static_assert(offsetof(CloudBody, axis) == 48 && offsetof(CloudBody, type) == 60);
static_assert(offsetof(CloudBody, samples_x) == 64 && offsetof(CloudBody, first_slice) == 76);
static_assert(offsetof(CloudBody, cell_km) == 80 && offsetof(CloudBody, turn_y) == 92);
static_assert(offsetof(CloudBody, shift_x) == 96 && offsetof(CloudBody, lobe_weight) == 104);
static_assert(offsetof(CloudBody, lobe_g) == 108 && offsetof(CloudBody, second_alpha) == 120);
static_assert(sizeof(CloudBlock) <= 16384);  // what every device takes
}  // namespace welkin::interop
#endif

#endif
