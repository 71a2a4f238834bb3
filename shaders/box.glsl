// What a picture shows of a periodic suspension ends at the faces of a box along the axes of the scene; places are those
// of the camera.
//   BOXED    what is outside is not drawn
//   CAPPED   with BOXED: the section of a membrane by a face is filled, as of a solid body
#ifdef BOXED
uniform vec3 u_low, u_high;
bool outside_box(vec3 place) { return any(lessThan(place, u_low)) || any(greaterThan(place, u_high)); }
#endif
#ifdef CAPPED
// How far from a place in the box towards the eye the line of sight comes in, and through which face.
float to_face(vec3 place, vec3 toward, out vec3 normal) {
  float least = 1e9;
  normal = vec3(0.0);
  for (int k = 0; k < 3; ++k) {
    float face = toward[k] > 0.0 ? u_high[k] : u_low[k], way = abs(toward[k]) > 1e-6 ? (face - place[k]) / toward[k] : 1e9;
    if (way < least) {
      least = way;
      normal = vec3(0.0);
      normal[k] = sign(toward[k]);
    }
  }
  return least;
}
#endif
