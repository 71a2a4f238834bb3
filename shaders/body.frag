// A membrane. Variants are compiled by #define: the software rasteriser executes every branch of a shader.
//   PARALLELS MERIDIANS CAP_STEP MIDDLE_STEP CAP_THETA MIDDLE_THETA   the grid
//   CHECKER     patches between PARALLELS and MERIDIANS
//   MARKS       a red meridian and equator
//   FLAT        unlit
//   CONTOUR     the inner edge of the outline
//   TRACERS     number of tracer dots
in vec3 v_eye, v_normal, v_label;
out vec4 f_colour;
uniform vec3 u_colour;       // linear
uniform vec3 u_line_colour;  // linear
uniform float u_half_width;  // of lines, samples
uniform bool u_perspective;
#ifdef CONTOUR
uniform vec3 u_contour;  // sRGB
#endif
#ifdef TRACERS
flat in vec4 v_dot, v_next_dot;  // the two tracers nearest to this triangle: eye space, w: 1 bright, 0 dark, -1 none
uniform vec3 u_tracer_bright, u_tracer_dark;
uniform float u_tracer_radius;
#endif

void main() {
  vec3 n = normalize(v_normal);
  vec3 v = u_perspective ? normalize(-v_eye) : vec3(0.0, 0.0, 1.0);
  vec3 albedo = u_colour;
  float gloss = 1.0;
  LabelPoint p = label_point(v_label);

#ifdef CHECKER
  // Product of two sawtooth-like waves; their signs change on the lines. Smoothed over a sample by the gradient.
  const float theta_step = pi / float(PARALLELS + 1);
  float wave_theta = sin(pi * p.theta / theta_step);
  float phi = atan(p.s.y, p.s.x);
  float wave_phi = sin(0.5 * float(MERIDIANS) * phi);
  vec3 e_phi = vec3(-p.s.y, p.s.x, 0.0) / p.sine;
  float across_theta = wave_theta / (pi / theta_step * slope(p, p.e_theta));
  float across_phi = wave_phi * p.sine / (0.5 * float(MERIDIANS) * slope(p, e_phi));
  float sign_theta = clamp(across_theta, -0.5, 0.5) * 2.0, sign_phi = clamp(across_phi, -0.5, 0.5) * 2.0;
  albedo = mix(albedo, u_line_colour * 1.6 + 0.28 * albedo, 0.5 + 0.5 * sign_theta * sign_phi);
#endif

#ifdef GRID
  float line = 0.0;
#ifdef PARALLELS
  line = max(line, parallels(p, u_half_width));
#endif
#ifdef MERIDIANS
  line = max(line, meridians(p, u_half_width));
  line = max(line, pole_dot(p, u_half_width));
#endif
  albedo = mix(albedo, u_line_colour, 0.93 * line);
  gloss *= 1.0 - 0.7 * line;
#endif

#ifdef MARKS
  float mark = max(parallel_line(p, 0.5 * pi, 1.9 * u_half_width), meridian_line(p, 0.0, 1.9 * u_half_width));
  albedo = mix(albedo, vec3(0.66, 0.02, 0.03), mark);
  gloss *= 1.0 - 0.7 * mark;
#endif

#ifdef TRACERS
  // Distance in space to the nearest dot on this side of the membrane: round whatever the label does.
  vec3 to_dot = v_eye - v_dot.xyz, to_next = v_eye - v_next_dot.xyz;
  bool next = v_next_dot.w >= 0.0 && dot(to_next, to_next) < dot(to_dot, to_dot);
  vec3 away = next ? to_next : to_dot;
  float bright = next ? v_next_dot.w : v_dot.w;
  float r = max(length(away), 1e-9);
  // change of r across one sample, from the derivatives of the position: those of r jump between dots
  float sample_size = max(length(vec2(dot(dFdx(v_eye), away), dot(dFdy(v_eye), away))) / r, 1e-9);
  float shown = bright < 0.0 ? 0.0 : 1.0;
  float ring = shown * (1.0 - smoothstep(-0.6, 0.6, (r - u_tracer_radius) / sample_size));
  float core = shown * (1.0 - smoothstep(-0.6, 0.6, (r - 0.66 * u_tracer_radius) / sample_size));
  albedo = mix(albedo, vec3(0.95), ring);
  albedo = mix(albedo, bright > 0.5 ? u_tracer_bright : u_tracer_dark, core);
  gloss = mix(gloss, 0.45, ring);
#endif

#ifdef FLAT
  vec3 colour = encode(albedo);
#else
  vec3 colour = encode(lit(albedo, n, v, gloss));
#endif

#ifdef CONTOUR
  // Toward a contour the cosine falls like the root of the distance, so its square over its gradient is the distance.
  float cosine = dot(n, v), square = cosine * cosine;
  float to_contour = square / max(length(vec2(dFdx(square), dFdy(square))), 1e-9);
  colour = mix(u_contour, colour, smoothstep(0.2, 1.5, to_contour));
#endif
  f_colour = vec4(colour, 1.0);
}
