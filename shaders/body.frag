// A membrane. Variants are compiled by #define: the software rasteriser executes every branch of a shader.
//   PARALLELS MERIDIANS CAP_STEP MIDDLE_STEP CAP_THETA MIDDLE_THETA   the grid
//   CHECKER     patches between PARALLELS and MERIDIANS
//   MARKS       a red meridian and equator
//   FLAT        unlit
//   GHOST       see-through, both sides
//   FIELD       colours of a map, unlit so that they can be read off its bar
//   SIGN_DOTS   with FIELD: dots on the lower half of the map
//   CUTAWAY     both sides, opened by a plane
//   CUT_BY_SAMPLE   with CUTAWAY: where there are no clip distances, as in WebGL 2
//   CONTOUR     the inner edge of the outline; with GHOST and CUTAWAY the whole outline
//   TRACERS     tracer dots
//   SPARSE      with GRID: vesicles so small that their lines fade to a few, or to none
//   OCCLUDED    hollows and neighbours darken it
//   DEPTH_CUE   fades into the ground with the distance
//   BOXED       ends at the faces of a box
in vec3 v_eye, v_normal, v_label;
flat in vec3 v_paint;  // linear
#ifdef CUT_BY_SAMPLE
in float v_cut;
#endif
#ifdef BOXED
in vec3 v_place;
#endif
out vec4 f_colour;
#ifdef GHOST
uniform float u_opacity;  // seen straight on
#endif
uniform vec3 u_line_colour;  // linear; a share of the membrane's own colour is added
uniform float u_half_width;  // of lines, samples
uniform bool u_perspective;
#ifdef CONTOUR
flat in vec3 v_contour;  // sRGB
#if defined(GHOST) || defined(CUTAWAY)
uniform float u_contour_width;  // samples: the whole outline is drawn here
in float v_from_contour;
flat in float v_contour_share;
#endif
#endif
#if defined(TRACERS) || defined(SPARSE)
flat in vec4 v_detail;
#endif
#ifdef OCCLUDED
in vec2 v_light;
#endif
#ifdef DEPTH_CUE
in float v_near;
uniform float u_height;  // of the picture, samples
#endif
#ifdef FIELD
in float v_scalar;
uniform sampler2D u_map;  // 256 texels, sRGB
#ifdef SIGN_DOTS
uniform float u_dot_spacing;  // half heights of the picture
// Round dots, evenly spread over the membrane itself however it stretches the label. They stand on rows of constant
// colatitude; where the membrane is stretched there are twice as many rows, or dots in a row. Every second one of those
// grows with the stretch, so that nothing appears at once. `shown` 0..1 scales all.
float sign_dot(LabelPoint p, float shown) {
  const float rows = 4.0;  // where nothing is doubled
  vec3 e_phi = vec3(-p.s.y, p.s.x, 0.0) / p.sine, dx = dFdx(v_eye), dy = dFdy(v_eye);
  mat2 label = mat2(dot(p.du, p.e_theta), dot(p.du, e_phi), dot(p.dv, p.e_theta), dot(p.dv, e_phi));
  float area = label[0].x * label[1].y - label[0].y * label[1].x;
  area = abs(area) < 1e-12 ? 1e-12 : area;
  // the membrane's tangents for a unit of the label
  vec3 along_theta = (dx * label[1].y - dy * label[0].y) / area, along_phi = (dy * label[0].x - dx * label[1].x) / area;
  float spacing = pi / rows, doubled = clamp(log2(length(along_theta) * spacing / u_dot_spacing), 0.0, 12.0);
  float between = spacing / exp2(floor(doubled) + 1.0);
  float row = clamp(floor(p.theta / between + 0.5), 0.0, floor(pi / between + 0.5));
  float size = mod(row, 2.0) > 0.5 ? smoothstep(0.0, 0.7, fract(doubled)) : 1.0;
  float theta = row * between, count = max(floor(2.0 * rows * sin(theta) + 0.5), 1.0);
  float apart = length(along_phi) * 2.0 * pi * sin(theta) / count;
  doubled = clamp(log2(max(apart, 1e-9) / u_dot_spacing), 0.0, 12.0);
  count *= exp2(floor(doubled) + 1.0);
  float phase = fract(9.42 * theta);
  float number = floor((atan(p.s.y, p.s.x) / (2.0 * pi) - phase) * count + 0.5);
  if (mod(number, 2.0) > 0.5) size *= theta < 0.5 * between || theta > pi - 0.5 * between ? 0.0 : smoothstep(0.0, 0.7, fract(doubled));
  float phi = 2.0 * pi * (number / count + phase);
  vec3 away = p.s - vec3(sin(theta) * cos(phi), sin(theta) * sin(phi), cos(theta));
  vec3 to_dot = along_theta * dot(away, p.e_theta) + along_phi * dot(away, e_phi);
  float r = max(length(to_dot), 1e-9);
  float sample_size = max(length(vec2(dot(dx, to_dot), dot(dy, to_dot))) / r, 1e-9);
  float densest = u_dot_spacing / max(length(dx), length(dy));  // samples
  return shown * smoothstep(2.5, 5.0, densest) * (1.0 - smoothstep(-0.6, 0.6, (r - DOT_RADIUS * shown * size * u_dot_spacing) / sample_size)) * smoothstep(0.0, 0.2, size);
}
#endif
#endif
#ifdef TRACERS
flat in vec4 v_dot, v_next_dot;  // the two tracers nearest to this triangle: eye space, w: 1 bright, 0 dark, -1 none
uniform vec3 u_tracer_bright, u_tracer_dark;
#endif

void main() {
  vec3 n = normalize(v_normal);
  vec3 v = u_perspective ? normalize(-v_eye) : vec3(0.0, 0.0, 1.0);
  vec3 albedo = v_paint, line_colour = u_line_colour + 0.07 * v_paint;
  float gloss = 1.0;
#if defined(GHOST) || defined(CUTAWAY)
  bool front = gl_FrontFacing;
  if (!front) n = -n;
#endif
#ifdef CUTAWAY
  if (!front) {  // the inside: duller, without shine
    albedo = 0.78 * mix(albedo, vec3(dot(albedo, vec3(0.2126, 0.7152, 0.0722))), 0.25);
    gloss = 0.25;
  }
#endif
#ifdef GHOST
  float grazing = 1.0 - clamp(dot(n, v), 0.0, 1.0);
  float alpha = mix(u_opacity, max(u_opacity, 0.80), grazing * grazing * sqrt(grazing));
  float drawn = max(u_opacity, front ? 0.92 : 0.45);  // alpha of what is painted on the membrane
#endif
#ifdef FIELD
  float place = 255.0 * clamp(v_scalar, 0.0, 1.0);
  int entry = min(int(place), 254);
  vec3 value = mix(texelFetch(u_map, ivec2(entry, 0), 0).rgb, texelFetch(u_map, ivec2(entry + 1, 0), 0).rgb,
                   place - float(entry));
  // Exactly the bar's colour, except where the membrane turns away by more than 60 degrees: there it darkens a little.
  vec3 field_colour = value * mix(0.80, 1.0, smoothstep(0.0, 0.5, dot(n, v)));
#endif
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
  albedo = mix(albedo, line_colour * 1.6 + 0.28 * albedo, 0.5 + 0.5 * sign_theta * sign_phi);
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
#ifdef SPARSE
  line = max(v_detail.x * line, v_detail.y * few_lines(p, u_half_width));
#endif
#ifdef FIELD
  // Lines must show on both ends of a map and leave its colours in between alone.
  float luma = dot(value, vec3(0.2126, 0.7152, 0.0722));
  vec3 on_field = mix(mix(field_colour, vec3(1.0), 0.42), 0.42 * field_colour, smoothstep(0.17, 0.25, luma));
  field_colour = mix(field_colour, on_field, 0.85 * line);
#endif
#ifdef CUTAWAY
  if (!front) line *= 0.6;
#endif
  albedo = mix(albedo, line_colour, 0.93 * line);
  gloss *= 1.0 - 0.7 * line;
#ifdef GHOST
  alpha = mix(alpha, max(alpha, drawn), line);
#endif
#endif

#ifdef MARKS
  float mark = max(parallel_line(p, 0.5 * pi, 3.0 * u_half_width), meridian_line(p, 0.0, 3.0 * u_half_width));  // told by width in grey
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
  float shown = bright < 0.0 ? 0.0 : v_detail.w, radius = v_detail.z;
  // Flat marks: dark ones whole, bright ones with a dark edge, so that both are told apart in grey. No pupils.
  bool is_bright = bright > 0.5;
  float core = shown * (1.0 - smoothstep(-0.6, 0.6, (r - (is_bright ? 0.66 : 0.62) * radius) / sample_size));
  float ring = is_bright ? shown * (1.0 - smoothstep(-0.6, 0.6, (r - 0.80 * radius) / sample_size)) : core;
  albedo = mix(albedo, u_tracer_dark, ring);
  if (is_bright) albedo = mix(albedo, u_tracer_bright, core);
  gloss = mix(gloss, 0.45, ring);
#ifdef GHOST
  alpha = mix(alpha, max(alpha, drawn), ring);
#endif
#endif

#if defined(FIELD)
#ifdef SIGN_DOTS
  vec3 dot_colour = dot(value, vec3(0.2126, 0.7152, 0.0722)) > 0.33 ? 0.35 * value : mix(value, vec3(1.0), 0.6);
  field_colour = mix(field_colour, dot_colour, sign_dot(p, clamp((0.5 - v_scalar) / DOT_FULL, 0.0, 1.0)));
#endif
  vec3 colour = field_colour;
#elif defined(FLAT)
  vec3 colour = encode(albedo);
#else
#ifdef OCCLUDED
  vec2 light = clamp(v_light, 0.0, 1.0);
#else
  const vec2 light = vec2(1.0);
#endif
  vec3 colour = encode(lit(albedo, n, v, gloss, light));
#endif

#ifdef CONTOUR
  // Toward a contour the cosine falls like the root of the distance, so its square over its gradient is the distance.
  float cosine = dot(n, v), square = cosine * cosine;
  float to_contour = square / max(length(vec2(dFdx(square), dFdy(square))), 1e-9);
#if defined(GHOST) || defined(CUTAWAY)
  // Where the membrane is nearly edge-on without turning over there is no contour, though the cosine is small.
  float contour_width = v_contour_share * u_contour_width;
  float turns_over = 1.0 - smoothstep(contour_width + 1.0, contour_width + 4.0, v_from_contour);
  float contour = turns_over * (1.0 - smoothstep(contour_width - 0.7, contour_width + 0.7, to_contour));
#else
  float contour = 1.0 - smoothstep(0.2, 1.5, to_contour);
#endif
  colour = mix(colour, v_contour, contour);
#ifdef GHOST
  alpha = mix(alpha, max(alpha, front ? 1.0 : drawn), contour);
  alpha *= mix(1.0, smoothstep(-0.3, 1.3, to_contour), turns_over);  // the edge of a polygon: a shade between
#endif
#endif
#ifdef CUT_BY_SAMPLE
  if (v_cut > 0.0) discard;  // last: derivatives need the neighbours
#endif
#ifdef BOXED
  if (outside_box(v_place)) discard;
#endif
#ifdef GHOST
#ifdef DEPTH_CUE
  alpha *= v_near;
#endif
  f_colour = vec4(colour, alpha);
#elif defined(DEPTH_CUE)
  f_colour = mix(ground(gl_FragCoord.y / u_height), vec4(colour, 1.0), v_near);
#else
  f_colour = vec4(colour, 1.0);
#endif
}
