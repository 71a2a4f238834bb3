// Programs from the shaders of the movies, and the uniforms that they share.

class Paint {
  constructor(gl, page) {
    this.gl = gl;
    this.page = page;
    this.programs = new Map();
    if (page.legend) this.map = this.texture(bytesOf(page.legend.colours));
  }

  texture(colours) {
    const { gl } = this, texture = gl.createTexture();
    gl.bindTexture(gl.TEXTURE_2D, texture);
    gl.pixelStorei(gl.UNPACK_ALIGNMENT, 1);
    gl.texImage2D(gl.TEXTURE_2D, 0, gl.RGB8, colours.length / 3, 1, 0, gl.RGB, gl.UNSIGNED_BYTE, colours);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MIN_FILTER, gl.NEAREST);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MAG_FILTER, gl.NEAREST);
    return texture;
  }

  program(name, defines = "") {
    const key = name + "\n" + defines;
    if (this.programs.has(key)) return this.programs.get(key);
    const { gl, page } = this;
    const before = suffix => page.libraries[name + suffix].map(part => page.shaders[part]).join("");
    if (before(".vert")) defines += page.defines;  // programs that know the distance
    const head = "#version 300 es\nprecision highp float;\nprecision highp int;\nprecision highp sampler2D;\n" + page.light + defines;
    const text = suffix => head + before(suffix) + page.shaders[name + suffix];
    const whole = gl.createProgram();
    for (const [kind, source] of [[gl.VERTEX_SHADER, text(".vert")], [gl.FRAGMENT_SHADER, text(".frag")]]) {
      const shader = gl.createShader(kind);
      gl.shaderSource(shader, source);
      gl.compileShader(shader);
      if (!gl.getShaderParameter(shader, gl.COMPILE_STATUS) && !gl.isContextLost())
        throw new Error(`the shader ${name} does not compile: ${gl.getShaderInfoLog(shader)}`);
      gl.attachShader(whole, shader);
    }
    gl.linkProgram(whole);
    if (!gl.getProgramParameter(whole, gl.LINK_STATUS) && !gl.isContextLost())
      throw new Error(`the shaders of ${name} do not fit together: ${gl.getProgramInfoLog(whole)}`);
    const places = new Map();
    const place = uniform => {
      if (!places.has(uniform)) places.set(uniform, gl.getUniformLocation(whole, uniform));
      return places.get(uniform);
    };
    const set = {
      number: (uniform, value) => gl.uniform1f(place(uniform), value),
      whole: (uniform, value) => gl.uniform1i(place(uniform), value),
      pair: (uniform, value) => gl.uniform2f(place(uniform), ...value),
      vector: (uniform, value) => gl.uniform3f(place(uniform), ...value),
      vectors4: (uniform, values) => gl.uniform4fv(place(uniform), values),
      matrix: (uniform, values) => gl.uniformMatrix4fv(place(uniform), false, values),
    };
    this.programs.set(key, { whole, set });
    return this.programs.get(key);
  }

  // The program, in use, with the camera.
  use(name, defines, camera) {
    const { whole, set } = this.program(name, defines);
    this.gl.useProgram(whole);
    if (camera) {
      set.matrix("u_view", camera.view);
      set.matrix("u_projection", camera.projection);
      set.whole("u_perspective", camera.perspective ? 1 : 0);
    }
    return set;
  }

  ground(set) {
    set.vector("u_top", this.page.paint.top);
    set.vector("u_bottom", this.page.paint.bottom);
    set.number("u_ground", 1);
    set.number("u_height", this.gl.drawingBufferHeight);
  }

  // What is far away fades into the ground.
  distance(set, camera) {
    const { depth_cue: share } = this.page.paint;
    if (share > 0) set.vector("u_cue", [share, (camera.depth - camera.distance) / camera.unit, 2 * camera.depth / camera.unit]);
    this.ground(set);
  }

}
