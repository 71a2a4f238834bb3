// The edge of a cut: a strip of constant width on the picture, made on the processor.
layout(location = 0) in vec4 a_clip;
layout(location = 1) in vec2 a_across;  // samples from the middle of the line; 0 faded .. 1
out float v_across, v_shown;
void main() {
  v_shown = a_across.y;
  v_across = a_across.x * a_clip.w;  // linear on the picture, also under perspective
  gl_Position = a_clip;
}
