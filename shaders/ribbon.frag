in float v_across, v_shown;
out vec4 f_colour;
uniform vec3 u_colour, u_rim;         // sRGB
uniform float u_half_width, u_core;   // samples
void main() {
  float across = abs(v_across * gl_FragCoord.w);
  float inner = 1.0 - smoothstep(u_core - 0.5, u_core + 0.5, across);
  f_colour = vec4(mix(u_rim, u_colour, inner), v_shown * (1.0 - smoothstep(u_half_width - 0.5, u_half_width + 0.5, across)));
}
