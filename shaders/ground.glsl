// The ground behind everything: a soft vertical gradient, height 0..1 from the bottom of the picture. Both ends are sRGB
// already, and close enough to be mixed as they are.
uniform vec3 u_top, u_bottom;
vec3 ground(float height) { return mix(u_bottom, u_top, smoothstep(0.0, 1.0, height)); }
