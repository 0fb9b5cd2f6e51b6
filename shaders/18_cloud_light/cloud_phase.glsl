// The phase function of a cloud: two lobes, each Draine's. Pure functions; 1/sr.
//
//   P = (1 - w) Draine(g1, alpha1) + w Draine(g2, alpha2)
//   alpha = 0 makes a lobe Henyey-Greenstein's. So this is Henyey-Greenstein (w = 0), two lobes of it, and the mixtures that
//   follow Mie's series: a narrow peak and a broad body.
// A lobe is given by 1 - g, because the peak of large droplets has g = 0.998: a float g keeps three digits of 1 - g, and the
// height of the peak goes as (1 - g)^-2. Cosines come as 1 - nu and 1 + nu (chapter 04).
//
// The including file gives HAS_* and MIE_PHASE, which sampling.glsl of chapter 07 wants for the air.
#ifndef WELKIN_CLOUD_PHASE_GLSL
#define WELKIN_CLOUD_PHASE_GLSL

#include "07_ground_truth/sampling.glsl"

// [cloud_phase]
struct PhaseLobe {
  float one_minus_g;  // (0, 2)
  float alpha;        // >= 0
};

struct CloudPhase {
  PhaseLobe first;
  PhaseLobe second;
  float second_weight;  // [0, 1]
};

// Draine's lobe. With a = 1 - |g|: (1-g)^2 + 2 g (1-nu) = a^2 + 2 (1-a) (1-nu), and (1-g)(1+g) = a (2 - a).
float lobe_phase(PhaseLobe lobe, float one_minus_nu, float one_plus_nu) {
  bool forward = lobe.one_minus_g <= 1.0;
  float a = forward ? lobe.one_minus_g : 2.0 - lobe.one_minus_g;
  float size = 1.0 - a;
  float base = max(a * a + 2.0 * size * (forward ? one_minus_nu : one_plus_nu), 1.0e-20);
  float nu = one_minus_nu < 1.0 ? 1.0 - one_minus_nu : one_plus_nu - 1.0;
  float body = (1.0 + lobe.alpha * nu * nu) / (1.0 + lobe.alpha * (1.0 + 2.0 * size * size) / 3.0);
  return 0.079577471545947668 * a * (2.0 - a) / (base * sqrt(base)) * body;
}

float cloud_phase(CloudPhase phase, float one_minus_nu, float one_plus_nu) {
  float value = lobe_phase(phase.first, one_minus_nu, one_plus_nu);
  if (phase.second_weight <= 0.0) return value;
  return value * (1.0 - phase.second_weight) + lobe_phase(phase.second, one_minus_nu, one_plus_nu) * phase.second_weight;
}
// [/cloud_phase]

// [mean_cosine]
// Of one lobe: g (1 + alpha (3 + 2 g^2)/5) / (1 + alpha (1 + 2 g^2)/3).
float lobe_mean_cosine(PhaseLobe lobe) {
  float g = 1.0 - lobe.one_minus_g;
  return g * (1.0 + lobe.alpha * (3.0 + 2.0 * g * g) / 5.0) / (1.0 + lobe.alpha * (1.0 + 2.0 * g * g) / 3.0);
}

float cloud_mean_cosine(CloudPhase phase) {
  return lobe_mean_cosine(phase.first) * (1.0 - phase.second_weight) + lobe_mean_cosine(phase.second) * phase.second_weight;
}
// [/mean_cosine]

// [phase_kinds]
CloudPhase henyey_greenstein_cloud(float g) {
  CloudPhase phase;
  phase.first.one_minus_g = 1.0 - g;
  phase.first.alpha = 0.0;
  phase.second = phase.first;
  phase.second_weight = 0.0;
  return phase;
}

CloudPhase double_hg_cloud(float g, float second_g, float second_weight) {
  CloudPhase phase = henyey_greenstein_cloud(g);
  phase.second.one_minus_g = 1.0 - second_g;
  phase.second_weight = second_weight;
  return phase;
}

// 1 - exp(-x) for x in [0, 1) by its series where the difference would cancel.
float one_minus_exp(float x) {
  if (x > 0.1) return 1.0 - exp(-x);
  return x * (1.0 - x * (0.5 - x * (0.16666666666666667 - x * (0.041666666666666667 - x * 0.0083333333333333333))));
}

// Water droplets by their diameter, 1.5 to 50 um: Jendersie and d'Eon's fit to Mie's series (2023). Peak: Henyey-Greenstein;
// body: Draine. Two ranges that meet at 5 um.
CloudPhase droplet_cloud(float diameter_um) {
  float d = clamp(diameter_um, 1.5, 50.0);
  CloudPhase phase;
  phase.first.alpha = 0.0;
  if (d >= 5.0) {
    phase.first.one_minus_g = one_minus_exp(0.0990567 / (d - 1.67154));
    phase.second.one_minus_g = 1.0 - exp(-2.20679 / (d + 3.91029) - 0.428934);
    phase.second.alpha = exp(3.62489 - 8.29288 / (d + 5.52825));
    phase.second_weight = exp(-0.599085 / (d - 0.641583) - 0.665888);
    return phase;
  }
  float l = log(d);
  float log_l = log(l);
  phase.first.one_minus_g = 0.059744 - 0.0604931 * log_l;
  phase.second.one_minus_g = 0.499589 + 0.081287 / (tan(l) - 2.0 * l + 1.27551);
  phase.second.alpha = 7.30354 * l + 6.31675;
  phase.second_weight = 0.026914 * (l - cos(5.68947 * (log_l - 0.0292149))) + 0.376475;
  return phase;
}
// [/phase_kinds]

// [cloud_turn]
// A turn drawn with the phase function as its density: a lobe by its weight, Henyey-Greenstein's turn in it (chapter 07), kept
// with a share (1 + alpha nu^2) / (1 + alpha), a third at least. After 64 tries the last is taken: 5e-12 of them.
struct CloudTurn {
  Turn turn;
  Random random;
};

CloudTurn cloud_turn(CloudPhase phase, Random random) {
  CloudTurn drawn;
  drawn.random = draw(random);
  PhaseLobe lobe = phase.first;
  if (drawn.random.value.x < phase.second_weight) lobe = phase.second;
  float g = 1.0 - lobe.one_minus_g;
  drawn.turn = henyey_greenstein_turn(g, drawn.random.value.y);
  bool kept = false;
  for (int i = 0; i < 64 && lobe.alpha > 0.0; i++) {
    float nu = 1.0 - drawn.turn.one_minus_nu;
    kept = drawn.random.value.z * (1.0 + lobe.alpha) <= 1.0 + lobe.alpha * nu * nu;
    if (kept) break;
    drawn.random = draw(drawn.random);
    drawn.turn = henyey_greenstein_turn(g, drawn.random.value.y);
  }
  return drawn;
}
// [/cloud_turn]

#endif
