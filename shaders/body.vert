// A membrane: everything else happens in the fragment shader.
layout(location = 0) in vec3 a_position;
layout(location = 1) in vec3 a_normal;
layout(location = 2) in vec3 a_label;
#ifdef GHOST
// Triangles of all membranes in one draw: what differs from one to the next comes with the vertices.
layout(location = 5) in vec3 a_colour;  // linear
flat out vec3 v_colour;
#endif
#ifdef TRACERS
#ifdef GHOST
layout(location = 3) in vec4 a_dot;
layout(location = 4) in vec4 a_next_dot;
#else
layout(location = 3) in vec2 a_dots;  // indices of the two nearest tracers; -1: none faces this way
uniform vec4 u_tracer[TRACERS];      // eye space, w: 1 bright, 0 dark
#endif
flat out vec4 v_dot, v_next_dot;
#endif
#ifdef FIELD
layout(location = 6) in float a_scalar;  // share of the colour bar
out float v_scalar;
#endif
#ifdef CUTAWAY
uniform vec4 u_cut;  // the half space u_cut . (x, 1) > 0 is taken away
#endif
uniform mat4 u_view, u_projection;
out vec3 v_eye;     // position in eye space
out vec3 v_normal;  // eye space
out vec3 v_label;   // on the unit sphere
void main() {
  vec4 eye = u_view * vec4(a_position, 1.0);
  v_eye = eye.xyz;
  v_normal = mat3(u_view) * a_normal;
  v_label = a_label;
#ifdef GHOST
  v_colour = a_colour;
#endif
#ifdef TRACERS
#ifdef GHOST
  v_dot = a_dot;
  v_next_dot = a_next_dot;
#else
  const vec4 none = vec4(0.0, 0.0, 0.0, -1.0);
  v_dot = a_dots.x < 0.0 ? none : u_tracer[int(a_dots.x)];
  v_next_dot = a_dots.y < 0.0 ? none : u_tracer[int(a_dots.y)];
#endif
#endif
#ifdef FIELD
  v_scalar = a_scalar;
#endif
#ifdef CUTAWAY
  gl_ClipDistance[0] = -dot(u_cut, vec4(a_position, 1.0));
#endif
  gl_Position = u_projection * eye;
}
