in vec3 v_eye, v_normal;
in float v_shown;
out vec4 f_colour;
uniform vec3 u_colour;  // linear
uniform bool u_perspective;
uniform float u_height;  // of the picture, samples
void main() {
  vec3 v = u_perspective ? normalize(-v_eye) : vec3(0.0, 0.0, 1.0);
  vec3 colour = encode(lit(u_colour, normalize(v_normal), v, 0.25, vec2(1.0)));
  f_colour = mix(ground(gl_FragCoord.y / u_height), vec4(colour, 1.0), v_shown);
}
