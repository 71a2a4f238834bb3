in vec2 v_place;
out vec4 f_colour;
void main() { f_colour = ground(v_place.y); }
