// The aureole, where light is scattered many times by small angles, against chapter 07's path tracer.
#include <catch2/catch.hpp>
#include <cmath>

#include "tests/gpu/09_sky.hpp"

using namespace welkin;
using namespace welkin::test;

// In thin haze the error is about a percent. On the dense planet the beam of the delta-scaled air includes light that
// the aerosol scattered forward. It is scattered once more by the sharp phase function, though the true light is
// already broader.
TEST_CASE("truth: the bright air about the sun") {
  const bool alien = GENERATE(false, true);
  for (const Aureole& one : aureole(alien ? "alien" : "earth", "32768"))
    for (int c = 0; c < 3; ++c) {
      CAPTURE(alien, one.angle_deg, c, one.error[c], one.noise[c]);
      CHECK(one.noise[c] < 0.02);
      CHECK(std::abs(one.error[c]) < (alien ? 0.6 : 0.02) + 4.0 * one.noise[c]);
    }
}
