out vec4 f_colour;
uniform vec3 u_colour;  // sRGB
void main() { f_colour = vec4(u_colour, 1.0); }
