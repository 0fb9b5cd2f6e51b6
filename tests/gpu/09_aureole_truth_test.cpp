// The bright air about the sun, where light is turned aside many times by little, against chapter 07's paths.
#include <catch2/catch.hpp>
#include <cmath>

#include "tests/gpu/09_sky.hpp"

using namespace welkin;
using namespace welkin::test;

// Thin haze is right to a percent. In the dense planet's the beam of the scaled air holds light that the aerosol sent
// ahead; it is scattered once more by the sharp phase function, where the true light is broader already.
TEST_CASE("truth: the bright air about the sun") {
  const bool alien = GENERATE(false, true);
  for (const Aureole& one : aureole(alien ? "alien" : "earth", "32768"))
    for (int c = 0; c < 3; ++c) {
      CAPTURE(alien, one.angle_deg, c, one.error[c], one.noise[c]);
      CHECK(one.noise[c] < 0.02);
      CHECK(std::abs(one.error[c]) < (alien ? 0.6 : 0.02) + 4.0 * one.noise[c]);
    }
}
