// A frame: the membranes of one time as meshes, and the passes that draw them, as render/draw of the program does.

const mostVertices = 60000;

class Scene {
  constructor(gl, page, data) {
    Object.assign(this, { gl, page, data, paint: new Paint(gl, page) });
    const count = page.vesicles.length;
    // as fine as the movies for one or two vesicles, coarser for a crowd
    this.mesh = new Mesh(Math.min(96, Math.max(16, 2 * Math.floor(Math.sqrt(mostVertices / count / 2) / 2))));
    const vertices = this.mesh.vertices * count;
    const array = size => new Float32Array(size * vertices);
    this.arrays = { position: array(3), normal: array(3), label: array(3), dot: array(4), next: array(4), paint: array(4),
                    detail: array(4), scalar: array(1), contour: array(3), outline: array(4), light: array(2), edge: array(1), cut: array(4) };
    this.coarse = new Mesh(sketchLatitudes);
    this.nearest = new Float32Array(2 * vertices);
    this.slopes = { theta: new Float32Array(3 * this.mesh.vertices), phi: new Float32Array(3 * this.mesh.vertices) };
    this.buffers = {};
    for (const name of Object.keys(this.arrays)) this.buffers[name] = this.buffer(this.arrays[name]);
    this.tracers = page.vesicles.map(() => []);
    this.nothing = gl.createVertexArray();
    this.makeBodies();
    this.surroundings = new Surroundings(gl, page, data, this.paint);
  }

  buffer(values) {
    const { gl } = this, buffer = gl.createBuffer();
    gl.bindBuffer(gl.ARRAY_BUFFER, buffer);
    gl.bufferData(gl.ARRAY_BUFFER, values, gl.DYNAMIC_DRAW);
    return buffer;
  }

  refill(buffer, values) {
    const { gl } = this;
    gl.bindBuffer(gl.ARRAY_BUFFER, buffer);
    gl.bufferSubData(gl.ARRAY_BUFFER, 0, values);
  }

  attribute(buffer, place, size, first = 0, divisor = 0) {
    const { gl } = this;
    gl.bindBuffer(gl.ARRAY_BUFFER, buffer);
    gl.enableVertexAttribArray(place);
    gl.vertexAttribPointer(place, size, gl.FLOAT, false, 0, 4 * size * first);
    gl.vertexAttribDivisor(place, divisor);
  }

  // All membranes in one draw: as they come, or sorted.
  makeBodies() {
    const { gl, mesh, page } = this, each = mesh.indices.length, all = new Uint32Array(each * page.vesicles.length);
    page.vesicles.forEach((_, v) => mesh.indices.forEach((k, i) => { all[v * each + i] = v * mesh.vertices + k; }));
    this.sorted = new Uint32Array(all.length);
    const vertexArray = places => {
      const made = gl.createVertexArray();
      gl.bindVertexArray(made);
      for (const [name, place, size] of places) this.attribute(this.buffers[name], place, size);
      return made;
    };
    const place = [["position", 0, 3], ["normal", 1, 3]];
    this.bodies = vertexArray([...place, ["label", 2, 3], ["dot", 3, 4], ["next", 4, 4], ["paint", 5, 4], ["detail", 6, 4],
                               ["scalar", 7, 1], ["cut", 8, 4], ["edge", 9, 1], ["contour", 10, 3], ["light", 11, 2]]);
    this.hulls = vertexArray([...place, ["outline", 2, 4]]);
    this.corners = gl.createBuffer();
    gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, this.corners);
    gl.bufferData(gl.ELEMENT_ARRAY_BUFFER, all, gl.STATIC_DRAW);
    gl.bindVertexArray(null);
    this.sortedCorners = gl.createBuffer();
  }

  // One value for all vertices of each vesicle.
  fill(name, valueOf) {
    const { mesh, arrays, page } = this, array = arrays[name];
    page.vesicles.forEach((vesicle, v) => {
      const value = valueOf(vesicle, v), size = value.length;
      for (let k = v * mesh.vertices * size, end = k + mesh.vertices * size; k < end; k += size)
        for (let c = 0; c < size; ++c) array[k + c] = value[c];
    });
    this.refill(this.buffers[name], array);
  }

  // Evaluates the membranes at a time counted in frames.
  evaluate(time) {
    const { mesh, arrays, slopes, page, data } = this, count = mesh.vertices;
    this.time = time;
    this.sketches = [];
    this.shaded = undefined;
    this.planes = this.inset = undefined;
    page.vesicles.forEach((vesicle, v) => {
      const series = data.vesicles[v], part = (name, size) => arrays[name].subarray(size * v * count, size * (v + 1) * count);
      const coefficients = numbersAt(series.position, time, vesicle.breaks);
      const position = part("position", 3), normal = part("normal", 3), label = part("label", 3);
      mesh.sample(coefficients, 3, position, slopes);
      if (page.paint.occlusion > 0) this.sketches.push(new Sketch(this.coarse, coefficients));
      for (let k = 0; k < 3 * count; k += 3) {
        const { theta, phi } = slopes;
        const x = theta[k + 1] * phi[k + 2] - theta[k + 2] * phi[k + 1], y = theta[k + 2] * phi[k] - theta[k] * phi[k + 2],
              z = theta[k] * phi[k + 1] - theta[k + 1] * phi[k], size = Math.sqrt(x * x + y * y + z * z) || 1;
        normal[k] = x / size;
        normal[k + 1] = y / size;
        normal[k + 2] = z / size;
      }
      if (page.paint.grid_lines) {
        label.set(mesh.parameters);
      } else {
        mesh.sample(numbersAt(series.labels, time, vesicle.breaks), 3, label);
        for (let k = 0; k < 3 * count; k += 3) {
          const size = Math.sqrt(label[k] ** 2 + label[k + 1] ** 2 + label[k + 2] ** 2) || 1;
          label[k] /= size;
          label[k + 1] /= size;
          label[k + 2] /= size;
        }
      }
      if (series.field.rows > 0) mesh.sample(numbersAt(series.field, time, vesicle.breaks), 1, part("scalar", 1));
      const places = numbersAt(series.tracers, time, vesicle.breaks), tracers = [];
      for (let k = 0; k + 2 < places.length; k += 3)
        tracers.push({ ...surfacePoint(coefficients, places.slice(k, k + 3)), bright: isBright(k / 3) });
      this.tracers[v] = tracers;
      nearestTracers(position, normal, tracers, this.nearest.subarray(2 * v * count, 2 * (v + 1) * count));
    });
    for (const name of ["position", "normal", "label", "scalar"]) this.refill(this.buffers[name], arrays[name]);
  }

  draw(styleName, camera, size, overlays) {
    const { gl, page } = this, style = page.styles.find(s => s.name === styleName) || page.styles[0];
    const matrices = camera.matrices(size), height = size.height / matrices.fit;
    // px of the page at a height of 1080 in samples
    const samples = (px, least) => size.scale * Math.max(px * height / 1080, Math.min(px, least));
    const details = page.vesicles.map((vesicle, v) => this.detailOf(v, matrices, size.height, height));
    const look = { style, details, overlays, matrices, axes: camera.axes, samples, size, height, line: samples(page.paint.line_width / 2, 0.42), outline: samples(page.paint.outline_width, 1) };
    gl.viewport(0, 0, gl.drawingBufferWidth, gl.drawingBufferHeight);
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    gl.enable(gl.CULL_FACE);
    gl.cullFace(gl.BACK);
    gl.disable(gl.DEPTH_TEST);
    this.paint.ground(this.paint.use("ground", ""));
    gl.bindVertexArray(this.nothing);
    gl.drawArrays(gl.TRIANGLES, 0, 3);
    gl.enable(gl.DEPTH_TEST);
    gl.blendFunc(gl.SRC_ALPHA, gl.ONE_MINUS_SRC_ALPHA);
    this.surroundings.draw(look, camera, Math.round(this.time), this.shadows(matrices));
    this.drawBodies(look);
    if (style.cut) this.drawCuts(look);
    else if (!style.see_through && page.paint.outline_width > 0) this.drawOutlines(look);
    gl.bindVertexArray(null);
  }

  // Some points of the membranes as the picture shows them.
  shadows(matrices) {
    const { mesh, arrays, page } = this, places = [], stride = Math.max(3, Math.floor(mesh.vertices * page.vesicles.length / 6000));
    for (let k = 0; k < arrays.position.length / 3; k += stride)
      places.push(placeOf(matrices, [arrays.position[3 * k], arrays.position[3 * k + 1], arrays.position[3 * k + 2]]));
    return places;
  }

  // What is painted on a vesicle of this size, as detail_of() of the program: weights of all lines, of the few in their
  // place, of the dots, and of the width of the contour. pictureHeight: the movie's in this window.
  detailOf(v, { view, unit, distance, perspective }, height, pictureHeight) {
    const { page, mesh, arrays } = this, { line_width, outline_width, full_detail, tracer_radius } = page.paint;
    if (full_detail) return { lines: 1, fewLines: 0, tracers: 1, outline: 1 };
    const poles = 3 * ((v + 1) * mesh.vertices - 2), middle = [0, 1, 2].map(k => (arrays.position[poles + k] + arrays.position[poles + 3 + k]) / 2);
    const near = perspective ? distance / unit / Math.max(-eyePlace({ view }, middle)[2], 0.02 * distance / unit) : 1;
    const radius = page.vesicles[v].radius * near * height / (2 * unit);
    const spacing = Math.PI / 12 * radius / Math.max(line_width * pictureHeight / 1080, Math.min(line_width, 0.84), 1e-3);
    const width = outline_width * pictureHeight / 1080;
    return { lines: smoothstep(4.5, 7.5, spacing), fewLines: smoothstep(1.8, 3.2, spacing), tracers: smoothstep(1.6, 2.8, tracer_radius * radius),
             outline: width > 0 ? Math.min(Math.max(radius / (20 * width), 0.45), 1) : 1 };
  }

  // What the vertices carry of the vesicles, the style and the camera.
  prepare(look) {
    const { style, matrices, details } = look, { page, arrays, mesh } = this;
    if (style.occluded) this.lightUp(look);
    if (style.cut) this.open();
    if ((style.see_through || style.cut) && page.paint.outline_width > 0) {
      page.vesicles.forEach((_, v) => contourDistances(mesh, arrays.position, arrays.normal, v * mesh.vertices, matrices,
                                                       this.gl.drawingBufferHeight / 2, look.outline + 6, arrays.edge));
      this.refill(this.buffers.edge, arrays.edge);
    }
    if (this.prepared !== style) {
      this.fill("contour", vesicle => style.see_through ? vesicle.ghost_contour : vesicle.contour);
      this.prepared = style;
    }
    this.fill("paint", (vesicle, v) => [...(style.own_colour ? vesicle.colour : [1, 1, 1]), details[v].outline]);
    if (style.tracers || look.sparse)
      this.fill("detail", (vesicle, v) => [details[v].lines, details[v].fewLines, page.paint.tracer_radius * vesicle.radius / matrices.unit, details[v].tracers]);
    if (!style.tracers) return;
    this.tracers.forEach((tracers, v) => {
      const places = tracers.map(tracer => [...eyePlace(matrices, tracer.point), tracer.bright ? 1 : 0]), none = [0, 0, 0, -1];
      for (let k = v * mesh.vertices; k < (v + 1) * mesh.vertices; ++k) {
        arrays.dot.set(places[this.nearest[2 * k]] || none, 4 * k);
        arrays.next.set(places[this.nearest[2 * k + 1]] || none, 4 * k);
      }
    });
    this.refill(this.buffers.dot, arrays.dot);
    this.refill(this.buffers.next, arrays.next);
  }

  // The planes of the cuts and their edges, once for each time.
  open() {
    const { page, mesh, arrays, data } = this;
    if (this.planes) return;
    this.planes = cutPlanes(mesh, arrays.position, page.vesicles.length, page.cut, numbersAt(data.through, this.time, []));
    this.cuts = page.vesicles.map((vesicle, v) => ({ vesicle, curves: cutEdges(mesh, arrays.position, v * mesh.vertices, this.planes[v]) }));
    this.fill("cut", (_, v) => this.planes[v]);
  }

  // Of the inset, once for each time.
  sections() {
    const { page, mesh, arrays } = this;
    this.inset ??= page.vesicles.map((vesicle, v) => ({ vesicle, curves: cutEdges(mesh, arrays.position, v * mesh.vertices, [0, 1, 0, 0]) }));
    return this.inset;
  }

  drawCuts(look) { this.surroundings.drawCuts(look, Math.round(this.time), this.cuts); }

  // The key light turns with the camera.
  lightUp({ axes, matrices, size }) {
    const { page, arrays, mesh, sketches } = this, [x, y, z] = page.paint.key_light;
    const key = unit(combined([x, axes.right], [y, axes.up], [z, axes.back]));
    const large = v => page.vesicles[v].radius / matrices.unit * size.height / 2 > largeRadius;
    const shaded = [...key, ...page.vesicles.map((_, v) => large(v))].join();
    if (this.shaded === shaded) return;
    this.shaded = shaded;
    page.vesicles.forEach((_, v) => shade(mesh, v, sketches, key, large(v), 0.75 * page.paint.occlusion,
                                          arrays.light.subarray(2 * v * mesh.vertices, 2 * (v + 1) * mesh.vertices)));
    this.refill(this.buffers.light, arrays.light);
  }

  drawBodies(look) {
    const { gl, page, mesh, arrays } = this, { style, matrices, height } = look;
    look.sparse = style.defines.includes("#define GRID") && look.details.some(d => d.lines < 1);
    this.prepare(look);
    const set = this.paint.use("body", style.defines + (look.sparse ? "#define SPARSE\n" : ""), matrices);
    this.paint.distance(set, matrices);
    set.vector("u_line_colour", page.paint.line_ink);
    set.number("u_contour_width", look.outline);
    set.number("u_half_width", look.line);
    set.number("u_opacity", page.paint.opacity);
    set.vector("u_tracer_bright", page.paint.tracer_bright);
    set.vector("u_tracer_dark", page.paint.tracer_dark);
    if (style.field) {
      gl.activeTexture(gl.TEXTURE0);
      gl.bindTexture(gl.TEXTURE_2D, this.paint.map);
      set.whole("u_map", 0);
      set.number("u_dot_spacing", 2 * Math.max(page.paint.sign_dot_spacing * height / 1080, page.paint.sign_dot_least) / height);
    }
    gl.bindVertexArray(this.bodies);
    if (!style.see_through) {
      if (style.cut) gl.disable(gl.CULL_FACE);
      gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, this.corners);
      gl.drawElements(gl.TRIANGLES, this.sorted.length, gl.UNSIGNED_INT, 0);
      gl.enable(gl.CULL_FACE);
      return;
    }
    sortBackToFront(matrices.view, arrays.position, mesh, page.vesicles.length, this.sorted);
    gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, this.sortedCorners);
    gl.bufferData(gl.ELEMENT_ARRAY_BUFFER, this.sorted, gl.DYNAMIC_DRAW);
    gl.enable(gl.BLEND);
    gl.disable(gl.DEPTH_TEST);
    gl.disable(gl.CULL_FACE);
    gl.drawElements(gl.TRIANGLES, this.sorted.length, gl.UNSIGNED_INT, 0);
    gl.enable(gl.CULL_FACE);
    gl.enable(gl.DEPTH_TEST);
    gl.disable(gl.BLEND);
  }

  drawOutlines(look) {
    const { gl, page } = this, { matrices } = look, step = page.paint.edge_step;
    this.fill("outline", (vesicle, v) => [...vesicle.contour, look.details[v].outline * look.outline]);
    const set = this.paint.use("outline", "", matrices);
    this.paint.distance(set, matrices);
    set.pair("u_sample", [2 / gl.drawingBufferWidth, 2 / gl.drawingBufferHeight]);
    const slack = 1.5;  // samples
    let count = 0;
    page.vesicles.forEach((_, v) => {
      const width = look.details[v].outline * look.outline;
      count = rimTriangles(this.mesh, this.arrays.position, this.arrays.normal, v * this.mesh.vertices, matrices,
                           2 * (width + step + slack) / gl.drawingBufferHeight, this.sorted, count);
    });
    gl.bindVertexArray(this.hulls);
    gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, this.sortedCorners);
    gl.bufferData(gl.ELEMENT_ARRAY_BUFFER, this.sorted.subarray(0, count), gl.DYNAMIC_DRAW);
    const hull = (more, share) => {
      set.number("u_more", more);
      set.number("u_alpha", share);
      gl.drawElements(gl.TRIANGLES, count, gl.UNSIGNED_INT, 0);
    };
    gl.cullFace(gl.FRONT);
    hull(-step, 1);
    gl.enable(gl.BLEND);
    gl.depthMask(false);
    hull(0, 1 / 2);
    hull(step, 1 / 3);
    gl.depthMask(true);
    gl.disable(gl.BLEND);
    gl.cullFace(gl.BACK);
  }
}

function smoothstep(low, high, x) {
  const t = Math.min(Math.max((x - low) / (high - low), 0), 1);
  return t * t * (3 - 2 * t);
}

function eyePlace({ view }, p) {
  return [0, 1, 2].map(r => view[r] * p[0] + view[4 + r] * p[1] + view[8 + r] * p[2] + view[12 + r]);
}

// Of the initial direction of tracer k: +x -x +y -y +z -z, then the corners of a cube; is x + y + z > 0?
function isBright(k) {
  if (k < 6) return k % 2 === 0;
  const corner = (k - 6) % 8;
  return (corner >> 2 & 1) + (corner >> 1 & 1) + (corner & 1) <= 1;
}

// For each vertex the two nearest tracers on its side of the membrane, -1 where there is none.
function nearestTracers(position, normal, tracers, out) {
  for (let v = 0; v < position.length / 3; ++v) {
    const x = position[3 * v], y = position[3 * v + 1], z = position[3 * v + 2];
    let first = Infinity, second = Infinity, nearest = -1, next = -1;
    for (let k = 0; k < tracers.length; ++k) {
      const { point: p, normal: n } = tracers[k], d = (x - p[0]) ** 2 + (y - p[1]) ** 2 + (z - p[2]) ** 2;
      if (d >= second || normal[3 * v] * n[0] + normal[3 * v + 1] * n[1] + normal[3 * v + 2] * n[2] < 0.2) continue;
      if (d < first) {
        second = first;
        next = nearest;
        first = d;
        nearest = k;
      } else {
        second = d;
        next = k;
      }
    }
    out[2 * v] = nearest;
    out[2 * v + 1] = next;
  }
}

// All triangles, the farthest first: a counting sort of depths in 65,536 steps.
function sortBackToFront(view, position, mesh, bodies, sorted) {
  const { indices, vertices } = mesh, each = indices.length / 3, count = each * bodies;
  const depth = new Float32Array(vertices * bodies), middle = new Float32Array(count);
  for (let v = 0; v < depth.length; ++v)
    depth[v] = view[2] * position[3 * v] + view[6] * position[3 * v + 1] + view[10] * position[3 * v + 2];
  let low = Infinity, high = -Infinity;
  for (let t = 0; t < count; ++t) {
    const first = Math.floor(t / each) * vertices, i = 3 * (t % each);
    middle[t] = depth[first + indices[i]] + depth[first + indices[i + 1]] + depth[first + indices[i + 2]];
    low = Math.min(low, middle[t]);
    high = Math.max(high, middle[t]);
  }
  const steps = 65536, scale = (steps - 1) / Math.max(high - low, 1e-30), starts = new Uint32Array(steps + 1);
  for (let t = 0; t < count; ++t) ++starts[Math.floor((middle[t] - low) * scale) + 1];
  for (let k = 0; k < steps; ++k) starts[k + 1] += starts[k];
  for (let t = 0; t < count; ++t) {
    const first = Math.floor(t / each) * vertices, i = 3 * (t % each), to = 3 * starts[Math.floor((middle[t] - low) * scale)]++;
    for (let k = 0; k < 3; ++k) sorted[to + k] = first + indices[i + k];
  }
}
