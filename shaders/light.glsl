// Light fixed to the camera: x right, y up, z toward the viewer. Everything is linear until encode().
//   KEY_LIGHT   where the key light is, defined before every shader
const vec3 key_direction = normalize(KEY_LIGHT);
const vec3 fill_direction = normalize(vec3(0.70, -0.25, 0.65));

vec3 decode(vec3 c) {
  return mix(c / 12.92, pow((c + 0.055) / 1.055, vec3(2.4)), step(0.04045, c));
}
vec3 encode(vec3 c) {
  c = clamp(c, 0.0, 1.0);
  return mix(c * 12.92, 1.055 * pow(c, vec3(1.0 / 2.4)) - 0.055, step(0.0031308, c));
}

// albedo: linear; n, v: unit vectors in eye space, v toward the eye; gloss 0..1 scales the highlights; open: shares of
// sky and key light that nothing hides.
vec3 lit(vec3 albedo, vec3 n, vec3 v, float gloss, vec2 open) {
  float ambient = open.x * mix(0.32, 0.55, 0.5 + 0.5 * n.y);
  float lambert = dot(n, key_direction);
  float half_lambert = 0.5 + 0.5 * lambert;
  float key = 0.58 * open.y * mix(max(lambert, 0.0), half_lambert * half_lambert, 0.6);
  float fill = 0.08 * max(dot(n, fill_direction), 0.0);
  vec3 colour = albedo * (ambient + key + fill);
  float shine = max(dot(n, normalize(key_direction + v)), 0.0);
  colour += gloss * open.y * (0.16 * pow(shine, 50.0) + 0.04 * pow(shine, 10.0));
  float grazing = 1.0 - max(dot(n, v), 0.0);
  colour += albedo * (open.x * 0.22 * grazing * grazing * grazing);
  return colour;
}
