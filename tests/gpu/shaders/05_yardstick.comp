// The yardstick of chapter 05's speed: 32 view samples times 8 light samples by the midpoint rule, as a bare loop with every
// number written in. No rules to choose from, no uniform block, no effects to leave out. What the chapter's march costs
// more than this is the price of being readable and adjustable.
#version 460
layout(local_size_x = 8, local_size_y = 8) in;
layout(binding = 0, rgba32f) uniform writeonly image2D target;
layout(push_constant) uniform Push {
  vec4 right, up, forward, sun;
  ivec4 size;
};

void main() {
  const ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(pixel, size.xy))) return;
  const vec2 across = 2.0 * (vec2(pixel) + 0.5) / vec2(size.xy) - 1.0;
  const vec3 view = normalize(forward.xyz + across.x * right.xyz - across.y * up.xyz);
  const float h0 = right.w, r0 = 6360.0 + h0, mu = view.z, mu_sun0 = sun.z;
  const vec3 difference = view - sun.xyz;
  const float one_minus_nu = 0.5 * dot(difference, difference), nu = 1.0 - one_minus_nu;
  // Length: to the ground if the ray meets it, else to the top.
  const float down = r0 * r0 * mu * mu - h0 * (12720.0 + h0);
  const bool ground = mu < 0.0 && down >= 0.0;
  const float out_c = (100.0 - h0) * (12820.0 + h0), root = sqrt(r0 * r0 * mu * mu + out_c);
  const float len = ground ? h0 * (12720.0 + h0) / (sqrt(max(down, 0.0)) - r0 * mu) : (mu >= 0.0 ? out_c / (r0 * mu + root) : root - r0 * mu);
  const float g = 0.8, d = 0.04 + 1.6 * one_minus_nu;
  const vec3 rayleigh = vec3(5.802e-3, 13.558e-3, 33.1e-3) * (0.0596831 * (1.0 + nu * nu));
  const float mie = 3.996e-3 * 0.1193662 * 0.36 * (1.0 + nu * nu) / (2.64 * d * sqrt(d));
  vec3 radiance = vec3(0.0), transmittance = vec3(1.0);
  const float dt = len / 32.0;
  for (int i = 0; i < 32; ++i) {
    const float t = (float(i) + 0.5) * dt, rise = t * (2.0 * r0 * mu + t);
    const float h = max(h0 + rise / (sqrt(max(r0 * r0 + rise, 0.0)) + r0), 0.0), r = 6360.0 + h;
    const vec3 density = vec3(exp(-h / 8.0), exp(-h / 1.2), max(1.0 - abs(h - 25.0) / 15.0, 0.0));
    const vec3 tau = (vec3(5.802e-3, 13.558e-3, 33.1e-3) * density.x + vec3(4.44e-3) * density.y + vec3(0.65e-3, 1.881e-3, 0.085e-3) * density.z) * dt;
    const float mu_sun = clamp((r0 * mu_sun0 + t * nu) / r, -1.0, 1.0);
    if (mu_sun >= 0.0 || h - r * mu_sun * mu_sun / (1.0 + sqrt(1.0 - mu_sun * mu_sun)) >= 0.0) {
      const float c = max((100.0 - h) * (12820.0 + h), 0.0), s = sqrt(r * r * mu_sun * mu_sun + c);
      const float ds = (mu_sun >= 0.0 ? c / max(r * mu_sun + s, 1.0e-20) : s - r * mu_sun) / 8.0;
      vec3 column = vec3(0.0);
      for (int j = 0; j < 8; ++j) {
        const float l = (float(j) + 0.5) * ds, climb = l * (2.0 * r * mu_sun + l);
        const float k = max(h + climb / (sqrt(max(r * r + climb, 0.0)) + r), 0.0);
        column += vec3(exp(-k / 8.0), exp(-k / 1.2), max(1.0 - abs(k - 25.0) / 15.0, 0.0)) * ds;
      }
      const vec3 depth = vec3(5.802e-3, 13.558e-3, 33.1e-3) * column.x + vec3(4.44e-3) * column.y + vec3(0.65e-3, 1.881e-3, 0.085e-3) * column.z;
      const vec3 mean = mix((1.0 - exp(-tau)) / max(tau, 1.0e-20), 1.0 - tau * (0.5 - tau * (1.0 / 6.0 - tau / 24.0)), lessThan(tau, vec3(0.05)));
      radiance += transmittance * (rayleigh * density.x + mie * density.y) * exp(-depth) * mean * dt;
    }
    transmittance *= exp(-tau);
  }
  if (ground) {
    const float mu_sun = clamp((r0 * mu_sun0 + len * nu) / 6360.0, -1.0, 1.0);
    if (mu_sun > 0.0) {
      const float ds = 1282000.0 / (6360.0 * mu_sun + sqrt(6360.0 * 6360.0 * mu_sun * mu_sun + 1282000.0)) / 8.0;
      vec3 column = vec3(0.0);
      for (int j = 0; j < 8; ++j) {
        const float l = (float(j) + 0.5) * ds, climb = l * (12720.0 * mu_sun + l), k = climb / (sqrt(6360.0 * 6360.0 + climb) + 6360.0);
        column += vec3(exp(-k / 8.0), exp(-k / 1.2), max(1.0 - abs(k - 25.0) / 15.0, 0.0)) * ds;
      }
      const vec3 depth = vec3(5.802e-3, 13.558e-3, 33.1e-3) * column.x + vec3(4.44e-3) * column.y + vec3(0.65e-3, 1.881e-3, 0.085e-3) * column.z;
      radiance += transmittance * 0.3 * exp(-depth) * (mu_sun * 0.31830989);
    }
  }
  imageStore(target, pixel, vec4(radiance, 1.0));
}
