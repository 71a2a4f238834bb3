out vec4 f_colour;
uniform vec3 u_colour;  // sRGB
uniform float u_alpha;
void main() { f_colour = vec4(u_colour, u_alpha); }
