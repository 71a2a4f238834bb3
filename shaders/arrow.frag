in vec3 v_eye, v_normal;
out vec4 f_colour;
uniform vec3 u_colour;  // linear
uniform bool u_perspective;
void main() {
  vec3 v = u_perspective ? normalize(-v_eye) : vec3(0.0, 0.0, 1.0);
  f_colour = vec4(encode(lit(u_colour, normalize(v_normal), v, 0.25)), 1.0);
}
