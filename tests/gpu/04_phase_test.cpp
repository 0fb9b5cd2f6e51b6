// Chapter 04: the double phase functions are normalised and shaped as they should be, and the shader's agree with them
// over a million inputs.
#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <functional>

#include "chapters/04_air/phase.hpp"
#include "tests/gpu/harness.hpp"

using namespace welkin;

namespace {

struct Moments {
  double integral, mean_cosine;
};

// Over the sphere: 2 pi integral p(1-nu) {1, nu} dnu, in two halves with 1 - nu = exp(-u) and 1 + nu = exp(-u): in u
// the narrowest peak at either end is as wide as any.
Moments moments(const std::function<double(double)>& p) {
  Moments m{0.0, 0.0};
  constexpr int steps = 200'000;
  constexpr double u_end = 40.0;  // 1 - nu down to 8e-18
  for (int i = 0; i < steps; ++i) {
    const double end = std::exp(-(i + 0.5) * u_end / steps);
    for (const double x : {end, 2.0 - end}) {
      const double weight = 2.0 * std::numbers::pi * p(x) * end * (u_end / steps);
      m.integral += weight;
      m.mean_cosine += weight * (1.0 - x);
    }
  }
  return m;
}

}  // namespace

TEST_CASE("04 phase: every phase function integrates to 1 and has its mean cosine") {
  // The substitution makes the midpoint rule exact to (u_end/steps)^2/24 = 2e-9.
  const auto check = [](const char* name, Moments m, double mean_cosine) {
    INFO(name);
    CHECK(m.integral == Approx(1.0).epsilon(1e-7));
    CHECK(m.mean_cosine == Approx(mean_cosine).margin(1e-7));
  };
  check("isotropic", moments([](double) { return phase::isotropic(); }), 0.0);
  check("rayleigh", moments([](double x) { return phase::rayleigh(1.0 - x); }), 0.0);
  check("anisotropic", moments([](double x) { return phase::rayleigh_anisotropic(1.0 - x, 0.035); }), 0.0);
  for (const double g : {-0.9, -0.3, 0.0, 0.5, 0.8, 0.95, 0.999}) {
    check("henyey_greenstein", moments([&](double x) { return phase::henyey_greenstein(x, g); }), g);
    check("cornette_shanks", moments([&](double x) { return phase::cornette_shanks(x, g); }),
          3.0 * g * (4.0 + g * g) / (5.0 * (2.0 + g * g)));
    for (const double alpha : {0.5, 20.0})
      check("draine", moments([&](double x) { return phase::draine(x, g, alpha); }),
            g * (1.0 + alpha * (3.0 + 2.0 * g * g) / 5.0) / (1.0 + alpha * (1.0 + 2.0 * g * g) / 3.0));
    check("double_hg", moments([&](double x) { return phase::double_hg(x, g, -0.3, 0.1); }), 0.9 * g - 0.03);
  }
}

TEST_CASE("04 phase: the printed slips do not integrate to 1") {
  // 1 + g^2 above a lobe instead of 1 - g^2.
  CHECK(moments([](double x) { return phase::henyey_greenstein(x, 0.8) * (1.64 / 0.36); }).integral ==
        Approx(4.556).margin(1e-3));
  // The anisotropic form with its numbers as printed, rounded: 9e-5 short of 1.
  CHECK(0.7629 * (1.0 + 0.932 / 3.0) == Approx(0.99991).margin(1e-5));
  CHECK(phase::rayleigh_anisotropic(0.0, 0.035) * 4.0 * std::numbers::pi == Approx(0.7629).margin(1e-4));
  CHECK(phase::rayleigh_anisotropic(1.0, 0.035) / phase::rayleigh_anisotropic(0.0, 0.035) ==
        Approx(1.932).margin(5e-4));
  // Octaves that scale the cosine instead of g.
  const double scaled[][2] = {{0.9, 0.42}, {0.81, 0.31}, {0.5, 0.20}};
  for (const auto& [factor, integral] : scaled)
    CHECK(moments([&, f = factor](double x) { return phase::henyey_greenstein(1.0 - f * (1.0 - x), 0.8); }).integral ==
          Approx(integral).margin(0.01));
}

TEST_CASE("04 phase: forward is brighter than backward, and limits join") {
  for (const double g : {0.1, 0.5, 0.8, 0.99}) {
    CHECK(phase::henyey_greenstein(0.0, g) > phase::henyey_greenstein(2.0, g));
    CHECK(phase::cornette_shanks(0.0, g) > phase::cornette_shanks(2.0, g));
    CHECK(phase::henyey_greenstein(0.5, g) ==
          Approx(phase::henyey_greenstein(1.5, -g)).epsilon(1e-12));  // turning around
    CHECK(phase::draine(0.3, g, 0.0) == Approx(phase::henyey_greenstein(0.3, g)).epsilon(1e-14));
    CHECK(phase::draine(0.3, g, 1.0) == Approx(phase::cornette_shanks(0.3, g)).epsilon(1e-14));
  }
  CHECK(phase::cornette_shanks(0.3, 0.0) == Approx(phase::rayleigh(0.7)).epsilon(1e-14));
  CHECK(phase::rayleigh_anisotropic(0.4, 0.0) == Approx(phase::rayleigh(0.4)).epsilon(1e-14));
}

TEST_CASE("04 phase: a million random inputs and every edge on the device, against double") {
  const std::array<float, 12> edges_x{0.0f, 1e-30f, 1e-12f, 1e-7f,      1e-4f, 0.5f,
                                      1.0f, 1.5f,   1.999f, 1.9999999f, 2.0f,  2.0000005f};
  const std::array<float, 13> edges_g{-1.0f, -0.9999999f, -0.999f, -0.8f,   -1e-6f,      0.0f, 1e-6f,
                                      0.5f,  0.8f,        0.999f,  0.9999f, 0.99999994f, 1.0f};
  const std::array<float, 4> edges_alpha{0.0f, 1.0f, 100.0f, 1e6f};
  std::vector<float> in;
  for (const float x : edges_x)
    for (const float g : edges_g)
      for (const float second : edges_g)
        for (const float alpha : edges_alpha)
          in.insert(in.end(), {x, g, second, alpha > 1.0f ? 1.0f : alpha, alpha, alpha > 1.0f ? 50.0f : 5.0f});
  const size_t edge_count = in.size() / 6;
  test::Random random(4);
  constexpr size_t kRandom = 1'000'000;
  for (size_t i = 0; i < kRandom; ++i) {
    const double x = random.next() % 2 == 0 ? random.uniform(0.0, 2.0) : random.log_uniform(1e-14, 2.0);
    const double one_minus = random.log_uniform(1e-4, 1.0), sign = random.next() % 4 == 0 ? -1.0 : 1.0;
    for (const double v : {x, sign * (1.0 - one_minus), random.uniform(-0.99, 0.99), random.uniform(0.0, 1.0),
                           random.log_uniform(1e-3, 100.0), random.uniform(5.0, 50.0)})
      in.push_back(static_cast<float>(v));
  }
  const std::vector<float> out = test::evaluate("tests/04_phase.comp", in, 6, 8);
  REQUIRE(out.size() == 8 * (edge_count + kRandom));
  double worst[7] = {};
  size_t not_finite = 0, negative = 0;
  for (size_t i = 0; i < edge_count + kRandom; ++i) {
    for (int k = 0; k < 7; ++k) {
      not_finite += !std::isfinite(out[8 * i + k]);
      negative += out[8 * i + k] < 0.0f;
    }
    if (i < edge_count) continue;
    const double x = in[6 * i], g = in[6 * i + 1], second = in[6 * i + 2], weight = in[6 * i + 3],
                 alpha = in[6 * i + 4], d = in[6 * i + 5];
    const double truth[7] = {phase::rayleigh(1.0 - x),
                             phase::rayleigh_anisotropic(1.0 - x, 0.035),
                             phase::henyey_greenstein(x, g),
                             phase::cornette_shanks(x, g),
                             phase::draine(x, g, alpha),
                             phase::double_hg(x, g, second, weight),
                             phase::droplet(x, d)};
    for (int k = 0; k < 7; ++k) worst[k] = std::max(worst[k], std::abs(out[8 * i + k] / truth[k] - 1.0));
  }
  CHECK(not_finite == 0);
  CHECK(negative == 0);
  // float32 rounds each of about ten operations by 6e-8. The droplet's peak has g = exp(-q), q down to 0.002: a
  // rounding of g by 6e-8 is 3e-5 of 1 - g, and the peak's height goes as (1-g)^-2.
  WARN(
      fmt::format("largest relative error: rayleigh {:.1e}, anisotropic {:.1e}, HG {:.1e}, CS {:.1e}, Draine {:.1e}, "
                  "double HG {:.1e}, droplet {:.1e}",
                  worst[0], worst[1], worst[2], worst[3], worst[4], worst[5], worst[6]));
  for (int k = 0; k < 6; ++k) CHECK(worst[k] < 2e-6);
  CHECK(worst[6] < 5e-4);
}
