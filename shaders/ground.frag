in vec2 v_place;
out vec4 f_colour;
void main() { f_colour = vec4(ground(v_place.y), 1.0); }
