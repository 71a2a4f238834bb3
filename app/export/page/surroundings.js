// What stands behind the membranes: arrows of the flow, rings where they are seen end-on, beads in a fluid at rest, and
// the edges of a periodic cell; as draw_arrows() and draw_flow_lines() of the program.

class Surroundings {
  constructor(gl, page, data, paint) {
    Object.assign(this, { gl, page, arrows: data.arrows, targets: data.targets, paint });
    const { position, normal } = page.rests ? beadShape() : arrowShape(page.arrow_shape), most = Math.max(1, ...page.arrow_counts);
    Object.assign(this, { vertices: position.length / 3, starts: new Float32Array(4 * most), vectors: new Float32Array(3 * most) });
    this.array = gl.createVertexArray();
    gl.bindVertexArray(this.array);
    this.attribute(this.buffer(position), 0, 3, 0);
    this.attribute(this.buffer(normal), 1, 3, 0);
    this.startBuffer = this.buffer(this.starts);
    this.vectorBuffer = this.buffer(this.vectors);
    this.attribute(this.startBuffer, 2, 4, 1);
    this.attribute(this.vectorBuffer, 3, 3, 1);
    this.ribbon = gl.createVertexArray();
    gl.bindVertexArray(this.ribbon);
    this.clipBuffer = gl.createBuffer();
    this.attribute(this.clipBuffer, 0, 4, 0);
    this.acrossBuffer = gl.createBuffer();
    this.attribute(this.acrossBuffer, 1, 2, 0);
    gl.bindVertexArray(null);
  }

  buffer(values) {
    const { gl } = this, buffer = gl.createBuffer();
    gl.bindBuffer(gl.ARRAY_BUFFER, buffer);
    gl.bufferData(gl.ARRAY_BUFFER, values, gl.DYNAMIC_DRAW);
    return buffer;
  }

  attribute(buffer, place, size, divisor) {
    const { gl } = this;
    gl.bindBuffer(gl.ARRAY_BUFFER, buffer);
    gl.enableVertexAttribArray(place);
    gl.vertexAttribPointer(place, size, gl.FLOAT, false, 0, 0);
    gl.vertexAttribDivisor(place, divisor);
  }

  refill(buffer, values) {
    const { gl } = this;
    gl.bindBuffer(gl.ARRAY_BUFFER, buffer);
    gl.bufferData(gl.ARRAY_BUFFER, values, gl.DYNAMIC_DRAW);
  }

  // shadows: places of the membranes in the picture, which arrows leave free.
  draw(look, camera, frame, shadows) {
    this.drawArrows(look, camera, frame, shadows);
    if (this.page.cell && !look.style.cut) this.drawCell(look, frame);
  }

  // Edges of the opened membranes: a bright core between two dark lines. Opened, they show the edges of the cell, too, in
  // their place.
  drawCuts({ matrices, samples }, frame, bodies) {
    const { page } = this, line = samples(Math.max(page.paint.outline_width, 1.6), 1), core = 0.9 * line, halfWidth = core + 0.9 * line;
    for (const { curves, vesicle } of bodies)
      this.withRibbons(vesicle.contour, halfWidth, () => {
        for (const curve of curves) {
          const eyes = curve.map(point => eyePlace(matrices, point));
          for (const eye of eyes) eye[2] += 0.004 * vesicle.radius / matrices.unit;
          this.drawRibbon(eyes, true, halfWidth + 1, matrices.projection, 1);
        }
      }, { width: core, colour: vesicle.cut_edge });
    if (page.cell) this.drawCell({ matrices, samples }, frame);
  }

  drawArrows({ matrices, samples, size, overlays }, camera, frame, shadows) {
    const { gl, page, starts, vectors } = this, count = page.arrow_counts[frame];
    const { back } = camera.home.axes, leading = [0, 1, 2].reduce((best, k) => Math.abs(back[k]) > Math.abs(back[best]) ? k : best, 0);
    const facing = smoothstep(0.2, 0.45, Math.abs(camera.axes.back[leading]));
    if (count === 0 || facing === 0) return;
    const eye = matrices.perspective ? combined([1, camera.shift], [matrices.distance, camera.axes.back]) : undefined, endOn = [];
    for (let k = 0; k < count; ++k) {
      const at = n => this.arrows.values[(6 * k + n) * page.frames + frame];
      const middle = [at(0), at(1), at(2)], vector = [at(3), at(4), at(5)], long = Math.hypot(...vector);
      const tail = placeOf(matrices, combined([1, middle], [-0.5, vector])), tip = placeOf(matrices, combined([1, middle], [0.5, vector]));
      let beside = Math.min(...[tail, placeOf(matrices, middle), tip].map(place => clearOfBoxes(overlays, place, size)));
      if (!camera.home.follows) beside = beside > 0.6 ? 1 : 0;  // arrows at rest are there or not
      let shown = facing * beside * clearOf(shadows, tail, tip);
      if (!page.rests) {
        if (long < page.paint.weakest_arrow * page.paint.longest_arrow * page.camera.half_height) shown = 0;
        const sight = eye ? combined([1, eye], [-1, middle]) : camera.axes.back;
        const along = dot(vector, sight) / (long * Math.hypot(...sight) || 1), asRing = smoothstep(0.94, 0.96, Math.abs(along));
        if (asRing * shown > 0) endOn.push({ middle, radius: page.paint.end_on_radius * long, toward: along > 0, shown: asRing * shown });
        shown *= 1 - asRing;
      }
      starts.set([...middle, shown], 4 * k);
      vectors.set(vector, 3 * k);
    }
    this.refill(this.startBuffer, starts);
    this.refill(this.vectorBuffer, vectors);
    const set = this.paint.use("arrow", page.rests ? "#define BEAD\n" : "", matrices);
    this.paint.ground(set);
    set.vector("u_colour", page.paint.arrow);
    set.number("u_thickness", page.paint.arrow_thickness * page.camera.half_height);
    gl.bindVertexArray(this.array);
    gl.drawArraysInstanced(gl.TRIANGLES, 0, this.vertices, count);
    gl.clear(gl.DEPTH_BUFFER_BIT);  // they stand behind everything
    if (endOn.length > 0) this.drawEndOn(endOn, matrices, samples(1.5, 0.5));
  }

  // core: of another colour, in the middle.
  withRibbons(colour, halfWidth, draw, core = { width: -2, colour }) {
    const { gl } = this, set = this.paint.use("ribbon", "");
    set.number("u_core", core.width);
    set.vector("u_colour", core.colour);
    set.number("u_half_width", halfWidth);
    set.vector("u_rim", colour);
    gl.enable(gl.BLEND);
    gl.depthMask(false);
    gl.disable(gl.CULL_FACE);
    gl.bindVertexArray(this.ribbon);
    draw();
    gl.enable(gl.CULL_FACE);
    gl.depthMask(true);
    gl.disable(gl.BLEND);
  }

  drawEndOn(arrows, matrices, halfWidth) {
    this.withRibbons(this.page.paint.ring, halfWidth, () => {
      for (const { middle, radius, toward, shown } of arrows) {
        const centre = eyePlace(matrices, middle), reach = radius / matrices.unit;
        const around = (x, y) => [centre[0] + reach * x, centre[1] + reach * y, centre[2]];
        const round = share => Array.from({ length: 40 }, (_, k) => around(share * Math.cos(Math.PI * k / 20), share * Math.sin(Math.PI * k / 20)));
        const draw = (points, closed) => this.drawRibbon(points, closed, halfWidth + 1, matrices.projection, shown);
        draw(round(1), true);
        if (toward) for (const share of [0.06, 0.14, 0.22]) draw(round(share), true);  // a dot
        else for (const sign of [-1, 1]) draw([around(-Math.SQRT1_2, -sign * Math.SQRT1_2), around(Math.SQRT1_2, sign * Math.SQRT1_2)], false);
      }
    });
  }

  drawCell({ matrices, samples }, frame) {
    const { page, targets } = this, target = [0, 1, 2].map(k => targets.values[k * page.frames + frame]), parts = 24;
    const nearest = matrices.projection[14] / (matrices.projection[10] - 1), halfWidth = samples(1.1, 0.4);
    this.withRibbons(page.paint.flow_line, halfWidth, () => {
      for (let along = 0; along < 3; ++along)
        for (const [b, c] of [[-1, -1], [-1, 1], [1, -1], [1, 1]]) {
          let edge = [];
          for (let k = 0; k <= parts; ++k) {
            const point = [];
            point[along] = (2 * k / parts - 1) * page.cell[along];
            point[(along + 1) % 3] = b * page.cell[(along + 1) % 3];
            point[(along + 2) % 3] = c * page.cell[(along + 2) % 3];
            const eye = eyePlace(matrices, combined([1, point], [-1, target])), visible = !matrices.perspective || -eye[2] > nearest;
            if (visible) edge.push(eye);
            if (edge.length > 1 && (!visible || k === parts)) this.drawRibbon(edge, false, halfWidth + 1, matrices.projection, 1);
            if (!visible) edge = [];
          }
        }
    });
  }

  // A strip along points before the eye, `reach` samples to both sides.
  drawRibbon(points, closed, reach, projection, shown) {
    const { gl } = this, n = points.length, sample = [2 / gl.drawingBufferWidth, 2 / gl.drawingBufferHeight];
    const clips = points.map(([x, y, z]) => [projection[0] * x, projection[5] * y, projection[10] * z + projection[14], projection[11] * z + projection[15]]);
    const strip = [], across = [];
    for (let k = 0; k < n + (closed ? 1 : 0); ++k) {
      const here = clips[k % n], before = clips[k > 0 || closed ? (k + n - 1) % n : 0], after = clips[k + 1 < n || closed ? (k + 1) % n : n - 1];
      const along = [0, 1].map(c => (after[c] / after[3] - before[c] / before[3]) / sample[c]), long = Math.max(Math.hypot(...along), 1e-9);
      const side = [-along[1] / long * sample[0] * here[3], along[0] / long * sample[1] * here[3]];
      for (const sign of [-1, 1]) {
        strip.push(here[0] + sign * reach * side[0], here[1] + sign * reach * side[1], here[2], here[3]);
        across.push(sign * reach, shown);
      }
    }
    this.refill(this.clipBuffer, new Float32Array(strip));
    this.refill(this.acrossBuffer, new Float32Array(across));
    gl.drawArrays(gl.TRIANGLE_STRIP, 0, strip.length / 4);
  }
}

function arrowShape(base64) {
  const numbers = new Float32Array(bytesOf(base64).buffer), half = numbers.length / 2;
  return { position: numbers.subarray(0, half), normal: numbers.subarray(half) };
}

// A sphere of radius 1, as bead_shape() of the program.
function beadShape() {
  const sides = 20, rings = sides / 2, step = Math.PI / rings, points = [];
  const put = (i, j) => points.push(Math.sin(step * i) * Math.cos(step * j), Math.sin(step * i) * Math.sin(step * j), Math.cos(step * i));
  for (let i = 0; i < rings; ++i)
    for (let j = 0; j < sides; ++j)
      for (const [a, b] of [[0, 0], [1, 0], [1, 1], [0, 0], [1, 1], [0, 1]]) put(i + a, j + b);
  const sphere = new Float32Array(points);
  return { position: sphere, normal: sphere };
}

// 0 under something that lies over the picture or close to it, 1 when the place is well away.
function clearOfBoxes(boxes, [x, y], { width, height }) {
  const half = height / 2, across = width / 2 + x * half, down = half - y * half, room = 0.02, ramp = 0.1;
  const aside = box => Math.max(box.left - across, across - box.right, box.top - down, down - box.bottom) / half;
  return Math.min(1, ...boxes.map(box => smoothstep(room, room + ramp, aside(box))));
}

// 0 when the segment touches a membrane's shadow, 1 when it is well away.
function clearOf(shadows, tail, tip) {
  const near = 0.03, far = 0.055, along = [tip[0] - tail[0], tip[1] - tail[1]];
  const length2 = Math.max(along[0] ** 2 + along[1] ** 2, 1e-12);
  let nearest2 = far * far;
  for (const [x, y] of shadows) {
    const u = Math.min(Math.max(((x - tail[0]) * along[0] + (y - tail[1]) * along[1]) / length2, 0), 1);
    nearest2 = Math.min(nearest2, (x - tail[0] - u * along[0]) ** 2 + (y - tail[1] - u * along[1]) ** 2);
  }
  return smoothstep(near, far, Math.sqrt(nearest2));
}
