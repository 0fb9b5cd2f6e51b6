// Numbers with 48 bits from two floats: x is the value rounded to float32, y what that rounding left over.
//
// Everything rests on two exact identities: a + b = s + e and a b = p + e, where s, p are the rounded results and e is
// again a float (Dekker 1971; Knuth, TAOCP 2, 4.2.2). Vulkan rounds +, - and * correctly, and `precise` keeps the
// compiler from "simplifying" e to 0. GLSL's fma() is not used: Vulkan lets it round twice, and then e is 0.
// Relative error about 2^-46 = 1.4e-14. Domain: magnitudes 1e-12 … 1e30, or 0.
#ifndef WELKIN_DOUBLE_FLOAT_GLSL
#define WELKIN_DOUBLE_FLOAT_GLSL

// [exact]
// s + e = a + b exactly.
vec2 two_sum(float a, float b) {
  precise float s = a + b;
  precise float b_in_s = s - a;
  precise float e = (a - (s - b_in_s)) + (b - b_in_s);
  return vec2(s, e);
}

// The same for |a| >= |b|, in three operations.
vec2 quick_two_sum(float a, float b) {
  precise float s = a + b;
  precise float e = b - (s - a);
  return vec2(s, e);
}

// Two halves of 12 bits with a = x + y exactly (Veltkamp): products of halves fit into a float.
vec2 split(float a) {
  precise float c = 4097.0 * a;
  precise float high = c - (c - a);
  precise float low = a - high;
  return vec2(high, low);
}

// p + e = a b exactly.
vec2 two_product(float a, float b) {
  precise float p = a * b;
  vec2 u = split(a);
  vec2 v = split(b);
  precise float e = ((u.x * v.x - p) + u.x * v.y + u.y * v.x) + u.y * v.y;
  return vec2(p, e);
}
// [/exact]

vec2 df(float a) { return vec2(a, 0.0); }

vec2 df_add(vec2 a, vec2 b) {
  vec2 s = two_sum(a.x, b.x);
  vec2 t = two_sum(a.y, b.y);
  precise float low = s.y + t.x;
  s = quick_two_sum(s.x, low);
  low = s.y + t.y;
  return quick_two_sum(s.x, low);
}

vec2 df_negate(vec2 a) { return vec2(-a.x, -a.y); }
vec2 df_subtract(vec2 a, vec2 b) { return df_add(a, df_negate(b)); }

vec2 df_multiply(vec2 a, vec2 b) {
  vec2 p = two_product(a.x, b.x);
  precise float low = p.y + (a.x * b.y + a.y * b.x);
  return quick_two_sum(p.x, low);
}

// a / b by long division with three float digits; b not 0.
vec2 df_divide(vec2 a, vec2 b) {
  float first = a.x / b.x;
  vec2 rest = df_subtract(a, df_multiply(b, df(first)));
  float second = rest.x / b.x;
  rest = df_subtract(rest, df_multiply(b, df(second)));
  return df_add(quick_two_sum(first, second), df(rest.x / b.x));
}

// Square root, 0 for a <= 0: the float root, then two steps of Newton's method.
vec2 df_sqrt(vec2 a) {
  if (a.x <= 0.0) return vec2(0.0);
  vec2 root = df(sqrt(a.x));
  for (int i = 0; i < 2; ++i) {
    vec2 rest = df_subtract(a, df_multiply(root, root));
    root = df_add(root, df(rest.x / (2.0 * root.x)));
  }
  return root;
}

#endif
