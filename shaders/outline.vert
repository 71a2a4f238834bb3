// Inverted hull: back faces, pushed outward along the projected normal by a constant number of samples. Its edge is that
// of a polygon, without shades between; hulls of several widths, one over the other, make up for that.
layout(location = 0) in vec3 a_position;
layout(location = 1) in vec3 a_normal;
layout(location = 2) in vec4 a_outline;  // sRGB, and the width in samples
uniform mat4 u_view, u_projection;
uniform vec2 u_sample;  // clip units
uniform float u_more;   // samples added to the width
flat out vec3 v_outline;
out float v_near;
#ifdef BOXED
out vec3 v_place;
#endif
void main() {
  vec4 eye = u_view * vec4(a_position, 1.0);
  vec4 clip = u_projection * eye;
  vec2 direction = (mat3(u_view) * a_normal).xy;
  clip.xy += (a_outline.w + u_more) * u_sample * clip.w * direction / max(length(direction), 1e-6);
  v_outline = a_outline.rgb;
#ifdef BOXED
  v_place = a_position;
#endif
  v_near = near_share(eye.z);
  gl_Position = clip;
}
