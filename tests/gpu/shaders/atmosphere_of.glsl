// The atmosphere of a harness from seven vectors, in the order of the block's members.
#include "interop/atmosphere.h"

Atmosphere atmosphere_of(vec4 rayleigh, vec4 mie_scattering, vec4 mie_extinction, vec4 ozone, vec4 shape, vec4 ground, vec4 sun) {
  return Atmosphere(rayleigh.xyz, rayleigh.w, mie_scattering.xyz, mie_scattering.w, mie_extinction.xyz, mie_extinction.w, ozone.xyz, ozone.w,
                    shape.x, shape.y, shape.z, shape.w, ground.xyz, ground.w, sun.xyz, sun.w);
}
