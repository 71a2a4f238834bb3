// Arrows of the flow: one unit arrow along x, instanced; or, with BEAD, spheres.
layout(location = 0) in vec3 a_position;
layout(location = 1) in vec3 a_normal;
layout(location = 2) in vec4 a_start;   // of the instance; w: 0 faded into the ground .. 1
#ifndef BEAD
layout(location = 3) in vec3 a_vector;  // its direction and length
#endif
uniform mat4 u_view, u_projection;
uniform float u_thickness;
out vec3 v_eye, v_normal;
out float v_shown;
void main() {
#ifdef BEAD
  vec3 place = a_start.xyz + 1.5 * u_thickness * a_position;
  vec3 normal = a_normal;
#else
  float size = length(a_vector);
  vec3 x = a_vector / max(size, 1e-9);
  vec3 y = normalize(cross(abs(x.z) < 0.9 ? vec3(0.0, 0.0, 1.0) : vec3(0.0, 1.0, 0.0), x));
  vec3 z = cross(x, y);
  // the head keeps its shape: x < 0 is measured from the tip in units of the thickness, x >= 0 is the tail
  float thickness = u_thickness * min(1.0, size / (9.0 * u_thickness));
  float along = a_position.x < 0.0 ? size + a_position.x * thickness : a_position.x;
  vec3 place = a_start.xyz + (along - 0.5 * size) * x + thickness * (a_position.y * y + a_position.z * z);
  vec3 normal = a_normal.x * x + a_normal.y * y + a_normal.z * z;
#endif
  vec4 eye = u_view * vec4(place, 1.0);
  v_eye = eye.xyz;
  v_normal = mat3(u_view) * normal;
  v_shown = a_start.w;
  gl_Position = u_projection * eye;
}
