// Which constituents the scene has, as specialization constants 0 to 3: included by entry points before medium.glsl.
// The values come from air_variant() in chapters/04_air/air.hpp; an entry point's own constants begin at 4.
#ifndef WELKIN_VARIANT_GLSL
#define WELKIN_VARIANT_GLSL

layout(constant_id = 0) const bool HAS_RAYLEIGH = true;
layout(constant_id = 1) const bool HAS_MIE = true;
layout(constant_id = 2) const bool HAS_OZONE = true;
layout(constant_id = 3) const int MIE_PHASE = 1;

#endif
