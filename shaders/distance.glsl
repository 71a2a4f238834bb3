// Depth cue: what is far away fades into the ground.
#ifdef DEPTH_CUE
uniform vec3 u_cue;  // share that fades at the far end; z of the near end in eye space; extent between both
#endif
float near_share(float z) {  // 1 near .. 1 - u_cue.x far
#ifdef DEPTH_CUE
  return 1.0 - u_cue.x * clamp((u_cue.y - z) / u_cue.z, 0.0, 1.0);
#else
  return 1.0;
#endif
}
