//   FLAT        unlit
//   DEPTH_CUE   fades into the ground with the distance
in vec3 v_eye;
flat in vec3 v_normal, v_colour;
in float v_near;
out vec4 f_colour;
uniform bool u_perspective;
uniform float u_height;  // of the picture, samples
void main() {
#ifdef FLAT
  vec3 colour = encode(v_colour);
#else
  vec3 v = u_perspective ? normalize(-v_eye) : vec3(0.0, 0.0, 1.0);
  vec3 colour = encode(lit(v_colour, v_normal, v, 0.0, vec2(1.0)));
#endif
#ifdef DEPTH_CUE
  f_colour = mix(ground(gl_FragCoord.y / u_height), vec4(colour, 1.0), v_near);
#else
  f_colour = vec4(colour, 1.0);
#endif
}
