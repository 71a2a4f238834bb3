// Soft vertical gradient; both ends are sRGB already, and close enough to be mixed as they are.
in vec2 v_place;
out vec4 f_colour;
uniform vec3 u_top, u_bottom;
void main() { f_colour = vec4(mix(u_bottom, u_top, smoothstep(0.0, 1.0, v_place.y)), 1.0); }
