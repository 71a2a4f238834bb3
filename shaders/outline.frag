//   DEPTH_CUE   fades into the ground with the distance
flat in vec3 v_outline;
in float v_near;
#ifdef BOXED
in vec3 v_place;
#endif
out vec4 f_colour;
uniform float u_alpha;   // 1: the core, which hides what is behind it
uniform float u_height;  // of the picture, samples
void main() {
#ifdef BOXED
  if (outside_box(v_place)) discard;
#endif
#ifdef DEPTH_CUE
  f_colour = u_alpha < 1.0 ? vec4(v_outline, u_alpha * v_near)
                           : mix(ground(gl_FragCoord.y / u_height), vec4(v_outline, 1.0), v_near);
#else
  f_colour = vec4(v_outline, u_alpha);
#endif
}
