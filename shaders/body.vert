// A membrane: everything else happens in the fragment shader.
layout(location = 0) in vec3 a_position;
layout(location = 1) in vec3 a_normal;
layout(location = 2) in vec3 a_label;
#ifdef TRACERS
layout(location = 3) in vec2 a_dots;  // indices of the two nearest tracers; -1: none faces this way
uniform vec4 u_tracer[TRACERS];      // eye space, w: 1 bright, 0 dark
flat out vec4 v_dot, v_next_dot;
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
#ifdef TRACERS
  const vec4 none = vec4(0.0, 0.0, 0.0, -1.0);
  v_dot = a_dots.x < 0.0 ? none : u_tracer[int(a_dots.x)];
  v_next_dot = a_dots.y < 0.0 ? none : u_tracer[int(a_dots.y)];
#endif
  gl_Position = u_projection * eye;
}
