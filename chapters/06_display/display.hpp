// From the linear picture to 8 bits: a light meter, a tone curve, the screen's curve, dithering. Chapters from here on
// show their pictures through it.
//
// Three passes: "histogram" counts log2 luminance, "exposure" turns the counts into a target and moves the exposure
// towards it, "display" draws. With an exposure set by hand the first two do not exist, nor do their buffers.
#pragma once

#include <string>
#include <vector>

#include "common/graph/effect.hpp"

namespace welkin {

std::vector<Knob> exposure_knobs();  // exposure.*
std::vector<Knob> display_knobs();   // display.*

// What the meter found, as it lies in its buffer.
struct ExposureState {
  float exposure;     // log2 of the factor light is multiplied by, before compensation
  float target;       // log2 of the factor it moves towards
  float mean_log2;    // mean log2 luminance of the samples between the two ranks
  uint32_t measured;  // samples with a luminance above 0
};

// On the board where there is a light meter: an ExposureState, and 256 counts.
struct Exposure {
  graph::Resource state, histogram;
};

// Share of the way to a target that is covered after `seconds`: 1 - exp(-seconds / tau), without cancellation; 1 where
// tau is 0.
double adapted_share(double seconds, double tau_s);

app::Effect exposure();
app::Effect display();

}  // namespace welkin
