// Membranes, all in one draw: what differs from one to the next comes with the vertices.
layout(location = 0) in vec3 a_position;
layout(location = 1) in vec3 a_normal;
layout(location = 2) in vec3 a_label;
layout(location = 5) in vec4 a_paint;  // linear colour; share of the contour's width
flat out vec3 v_paint;
#ifdef TRACERS
layout(location = 3) in vec4 a_dot;  // the two tracers nearest to this vertex: eye space, w: 1 bright, 0 dark, -1 none
layout(location = 4) in vec4 a_next_dot;
flat out vec4 v_dot, v_next_dot;
#endif
#if defined(TRACERS) || defined(SPARSE)
layout(location = 6) in vec4 a_detail;  // weights of all lines and of the few; radius and weight of the tracers
flat out vec4 v_detail;
#endif
#ifdef FIELD
layout(location = 7) in float a_scalar;  // share of the colour bar
out float v_scalar;
#endif
#ifdef CUTAWAY
layout(location = 8) in vec4 a_cut;  // the half space a_cut . (x, 1) > 0 is taken away
#ifdef CUT_BY_SAMPLE
out float v_cut;
#endif
#endif
#ifdef CONTOUR
layout(location = 10) in vec3 a_contour;  // sRGB
flat out vec3 v_contour;
#endif
#if defined(CONTOUR) && (defined(GHOST) || defined(CUTAWAY))
layout(location = 9) in float a_from_contour;  // samples along the membrane, as the picture shows it
out float v_from_contour;
flat out float v_contour_share;
#endif
#ifdef OCCLUDED
layout(location = 11) in vec2 a_light;  // shares of sky and key light that come here
out vec2 v_light;
#endif
#ifdef BOXED
out vec3 v_place;
#endif
uniform mat4 u_view, u_projection;
out vec3 v_eye;     // position in eye space
out vec3 v_normal;  // eye space
out vec3 v_label;   // on the unit sphere
#ifdef DEPTH_CUE
out float v_near;
#endif
void main() {
  vec4 eye = u_view * vec4(a_position, 1.0);
  v_eye = eye.xyz;
  v_normal = mat3(u_view) * a_normal;
  v_label = a_label;
#ifdef BOXED
  v_place = a_position;
#endif
  v_paint = a_paint.rgb;
#ifdef TRACERS
  v_dot = a_dot;
  v_next_dot = a_next_dot;
#endif
#if defined(TRACERS) || defined(SPARSE)
  v_detail = a_detail;
#endif
#ifdef FIELD
  v_scalar = a_scalar;
#endif
#ifdef CUTAWAY
  float cut = dot(a_cut, vec4(a_position, 1.0));
#ifdef CUT_BY_SAMPLE
  v_cut = cut;
#else
  gl_ClipDistance[0] = -cut;
#endif
#endif
#ifdef CONTOUR
  v_contour = a_contour;
#endif
#if defined(CONTOUR) && (defined(GHOST) || defined(CUTAWAY))
  v_from_contour = a_from_contour;
  v_contour_share = a_paint.w;
#endif
#ifdef OCCLUDED
  v_light = a_light;
#endif
#ifdef DEPTH_CUE
  v_near = near_share(eye.z);
#endif
  gl_Position = u_projection * eye;
}
