// What a cloud of droplets does to light, from how much water it holds and how large its droplets are. Pure functions.
//
// Units: liquid water content in g/m^3, effective radius in um (mean of r^3 over mean of r^2), extinction in 1/km, absorption of
// water in 1/m.
#ifndef WELKIN_CLOUD_OPTICS_GLSL
#define WELKIN_CLOUD_OPTICS_GLSL

// [cloud_optics]
// A droplet takes twice its cross-section out of the beam: sigma = 2 pi <r^2> n, and the water is 4/3 pi <r^3> n at 1e6 g/m^3.
// So sigma = 3 W / (2 rho r_e): the same water in smaller droplets is a darker cloud. With W in g/m^3 and r_e in um: 1500 W/r_e.
float cloud_extinction_per_km(float liquid_water_g_per_m3, float effective_radius_um) {
  return 1500.0 * liquid_water_g_per_m3 / effective_radius_um;
}

// 1 - single-scattering albedo of droplets that absorb little: the absorbed share of what enters a droplet is its mean path in
// it times the water's absorption. For refractive index n that path gives (Bohren and Huffman 1983, section 7.1)
//   1 - albedo = 2/3 a r (n^3 - (n^2 - 1)^(3/2)) / n   with a the absorption coefficient; n = 1.333: 0.842 a r.
float cloud_co_albedo(float water_absorption_per_m, float effective_radius_um) {
  return 0.842e-6 * water_absorption_per_m * effective_radius_um;
}

// Pure water at 680, 550 and 440 nm, 1/m (Pope and Fry 1997).
vec3 water_absorption_per_m() { return vec3(0.465, 0.0565, 0.00635); }
// [/cloud_optics]

#endif
