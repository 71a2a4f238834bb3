// The section of a membrane by a face of the box, filled as that of a solid body.
layout(location = 0) in vec3 a_position;
layout(location = 1) in vec3 a_normal;  // of the face
layout(location = 2) in vec3 a_colour;  // linear
uniform mat4 u_view, u_projection;
out vec3 v_eye;
flat out vec3 v_normal, v_colour;
out float v_near;
void main() {
  vec4 eye = u_view * vec4(a_position, 1.0);
  v_eye = eye.xyz;
  v_normal = mat3(u_view) * a_normal;
  v_colour = a_colour;
  v_near = near_share(eye.z);
  gl_Position = u_projection * eye;
}
