// The sky view table as an effect: the whole sky and ground seen from the camera's altitude, for this chapter and those
// after it.
//
// A pass that looks it up binds "sky_view_table"; its shader defines SKY_VIEW_BINDING and the constant SKY_VIEW_UNIT,
// and includes 10_sky_view_lut/sky_view.glsl. It asks sky_view_serves() of the frame's altitude first: where that is
// false the table is not kept, and the direct march of chapter 09 takes its place.
#pragma once

#include <memory>
#include <vector>

#include "chapters/09_multiple_scattering_lut/multiple_scattering_lut.hpp"

namespace welkin {

// sky_view.method, .size, .steps, .format, .highest.
std::vector<Knob> sky_view_knobs();

// Whether the sky seen from this altitude comes from the table, by the knobs sky_view.method and .highest.
bool sky_view_serves(const Settings& settings, double altitude_km);

// On the board: radiance by azimuth from the sun and height over the horizon.
struct SkyViewTable {
  graph::Resource image;
  float unit = 1.0f;  // what a stored 1 is worth: SKY_VIEW_UNIT
};

// Pass "sky view": one march of chapter 09 per texel, when the air, the camera's altitude or the sun's height has
// changed.
app::Effect sky_view();

}  // namespace welkin
