// Lines of a unit-sphere label, from the label as a vector: no seam, no pole in the parametrisation.
// Widths and distances are samples of the picture; gradients are analytic from the label's screen derivatives.
const float pi = 3.14159265358979;

struct LabelPoint {
  vec3 s, du, dv;     // unit label and its derivatives along x and y of the screen
  float sine, theta;  // distance from the axis, colatitude
  vec3 e_theta;
};

LabelPoint label_point(vec3 label) {
  LabelPoint p;
  p.s = normalize(label);
  p.du = dFdx(p.s);
  p.dv = dFdy(p.s);
  p.sine = max(length(p.s.xy), 1e-6);
  p.theta = atan(p.sine, p.s.z);
  p.e_theta = vec3(p.s.xy * (p.s.z / p.sine), -p.sine);
  return p;
}

// Length of the screen gradient of s . n.
float slope(LabelPoint p, vec3 n) { return max(length(vec2(dot(p.du, n), dot(p.dv, n))), 1e-9); }

float coverage(float distance, float half_width) {
  return 1.0 - smoothstep(half_width - 0.5, half_width + 0.5, distance);
}
// Lines nearer than a few pixels to each other fade, rather than close to a dark field.
float fade(float spacing, float half_width) { return smoothstep(2.5 * half_width, 7.0 * half_width, spacing); }

float parallel_line(LabelPoint p, float theta, float half_width) {
  return coverage(abs(p.theta - theta) / slope(p, p.e_theta), half_width);
}

// The plane through the axis at angle phi: smooth through the poles.
float meridian_line(LabelPoint p, float phi, float half_width) {
  vec3 n = vec3(-sin(phi), cos(phi), 0.0);
  return coverage(abs(dot(p.s, n)) / slope(p, n), half_width);
}

#ifdef PARALLELS
float parallels(LabelPoint p, float half_width) {
  const float spacing = pi / float(PARALLELS + 1);
  float k = clamp(floor(p.theta / spacing + 0.5), 1.0, float(PARALLELS));
  return parallel_line(p, k * spacing, half_width) * fade(spacing / slope(p, p.e_theta), half_width);
}
#endif

#ifdef MERIDIANS
// Graticule rule: every CAP_STEP-th meridian runs to the pole, every MIDDLE_STEP-th to the first parallel from it,
// the others to the second.
float meridians(LabelPoint p, float half_width) {
  const float spacing = 2.0 * pi / float(MERIDIANS);
  float from_pole = min(p.theta, pi - p.theta);
  float stride = from_pole < CAP_THETA ? float(CAP_STEP) : from_pole < MIDDLE_THETA ? float(MIDDLE_STEP) : 1.0;
  float phi = atan(p.s.y, p.s.x);
  float nearest = floor(phi / (stride * spacing) + 0.5) * stride * spacing;
  vec3 n = vec3(-sin(nearest), cos(nearest), 0.0);
  float gap = p.sine * stride * spacing / slope(p, n);
  // in the cap the few meridians meet at the pole, which carries a dot
  float shown = from_pole < CAP_THETA ? 1.0 : fade(gap, half_width);
  return meridian_line(p, nearest, half_width) * shown;
}

float pole_dot(LabelPoint p, float half_width) {
  vec2 gradient = vec2(dot(p.du.xy, p.s.xy), dot(p.dv.xy, p.s.xy)) / p.sine;
  return coverage(p.sine / max(length(gradient), 1e-9), 2.6 * half_width);
}
#endif

#ifdef SPARSE
// What stays of the lines on small vesicles: the equator and four meridians.
float few_lines(LabelPoint p, float half_width) {
  return max(parallel_line(p, 0.5 * pi, half_width),
             max(meridian_line(p, 0.0, half_width), meridian_line(p, 0.5 * pi, half_width)));
}
#endif
