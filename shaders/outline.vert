// Inverted hull: back faces, pushed outward along the projected normal by a constant number of samples. Its edge is that
// of a polygon, without shades between; hulls of several widths, one over the other, make up for that.
layout(location = 0) in vec3 a_position;
layout(location = 1) in vec3 a_normal;
uniform mat4 u_view, u_projection;
uniform vec2 u_push;  // clip units per sample, times the width
void main() {
  vec4 clip = u_projection * (u_view * vec4(a_position, 1.0));
  vec2 direction = (mat3(u_view) * a_normal).xy;
  clip.xy += u_push * clip.w * direction / max(length(direction), 1e-6);
  gl_Position = clip;
}
