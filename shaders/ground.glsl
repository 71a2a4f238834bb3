// The ground behind everything: a soft vertical gradient, height 0..1 from the bottom of the picture. Both ends are sRGB
// already, and close enough to be mixed as they are; alpha 0: nothing, premultiplied.
uniform vec3 u_top, u_bottom;
uniform float u_ground;  // 1, or 0 where the picture is to be transparent
vec4 ground(float height) { return u_ground * vec4(mix(u_bottom, u_top, smoothstep(0.0, 1.0, height)), 1.0); }
