// The sky view table as an effect, for this chapter and those after it: sky and ground seen from the camera's altitude
// in all directions.
//
// A pass that looks it up binds "sky_view_table". Its shader defines SKY_VIEW_BINDING and the constant SKY_VIEW_UNIT,
// and includes 10_sky_view_lut/sky_view.glsl. The pass first calls uses_sky_view_table() for the frame's altitude:
// where that is false the table is not kept up to date, and the direct march of chapter 09 replaces it.
#pragma once

#include <memory>
#include <vector>

#include "chapters/09_multiple_scattering_lut/multiple_scattering_lut.hpp"

namespace welkin {

// The knobs sky_view.method, .size, .steps, .format, .highest.
std::vector<Knob> sky_view_knobs();

// Whether the sky seen from this altitude is looked up in the table, by the knobs sky_view.method and .highest.
bool uses_sky_view_table(const Settings& settings, double altitude_km);

// On the board: radiance by azimuth from the sun and angle above or below the horizon.
struct SkyViewTable {
  graph::Resource image;
  float unit = 1.0f;  // SKY_VIEW_UNIT: radiance of a stored 1
};

// Pass "sky view": marches chapter 09's sky for every texel when the air, the camera's altitude or the sun's zenith
// angle has changed.
app::Effect sky_view();

}  // namespace welkin
