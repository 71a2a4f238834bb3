// The edge of a cut: a strip of constant width on the picture, made on the processor.
layout(location = 0) in vec4 a_clip;
layout(location = 1) in float a_across;  // samples from the middle of the line
out float v_across;
void main() {
  v_across = a_across * a_clip.w;  // linear on the picture, also under perspective
  gl_Position = a_clip;
}
