// What a picture shows of a periodic suspension ends at the faces of a box along the axes of the scene; places are those
// of the camera.
//   BOXED   what is outside is not drawn
#ifdef BOXED
uniform vec3 u_low, u_high;
bool outside_box(vec3 place) { return any(lessThan(place, u_low)) || any(greaterThan(place, u_high)); }
#endif
