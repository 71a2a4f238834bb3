// How much light hollows and neighbours leave to each vertex: discs on a coarse net hide shares of the sky and of the key
// light, as render/scene/occlusion of the program has it.

const sketchLatitudes = 12, sketchRings = sketchLatitudes + 1, sketchColumns = 2 * sketchLatitudes;
const largeRadius = 80;  // px: from here on all discs count

// A membrane before it is sampled finely: points and outward normals times the area that a point stands for, none for
// poles; latitude varies fastest.
class Sketch {
  constructor(mesh, coefficients) {
    const position = new Float32Array(3 * mesh.vertices);
    const slopes = { theta: new Float32Array(3 * mesh.vertices), phi: new Float32Array(3 * mesh.vertices) };
    mesh.sample(coefficients, 3, position, slopes);
    const count = sketchRings * sketchColumns, step = Math.PI / sketchLatitudes, north = mesh.rings * sketchColumns;
    this.points = [];
    this.areas = [];
    this.centre = [0, 0, 0];
    for (let j = 0; j < sketchColumns; ++j)
      for (let i = 0; i < sketchRings; ++i) {
        const pole = i === 0 || i === sketchRings - 1, k = 3 * (i === 0 ? north : pole ? north + 1 : j * mesh.rings + i - 1);
        const at = values => [values[k], values[k + 1], values[k + 2]];
        this.points.push(at(position));
        this.areas.push(pole ? [0, 0, 0] : scaled(cross(at(slopes.theta), at(slopes.phi)), step * step));
        this.centre = combined([1, this.centre], [1 / count, at(position)]);
      }
    this.radius = 1.1 * Math.max(...this.points.map(p => Math.hypot(...combined([1, p], [-1, this.centre]))));
    this.fine = [];
    this.coarse = [];
    const index = (i, j) => j % sketchColumns * sketchRings + i;
    for (let j = 0; j < sketchColumns; ++j)
      for (let i = 1; i < sketchRings - 1; ++i) addDisc(this.fine, this.points[index(i, j)], this.areas[index(i, j)]);
    for (let j = 0; j < sketchColumns; j += 2)
      for (let i = 0; i < sketchRings - 1; i += 2) {
        let place = [0, 0, 0], area = [0, 0, 0], sum = 0;
        for (const k of [index(i, j), index(i + 1, j), index(i, j + 1), index(i + 1, j + 1)]) {
          const size = Math.hypot(...this.areas[k]);
          place = combined([1, place], [size, this.points[k]]);
          area = combined([1, area], [1, this.areas[k]]);
          sum += size;
        }
        if (sum > 0) addDisc(this.coarse, scaled(place, 1 / sum), area);
      }
    this.fine = new Float64Array(this.fine);
    this.coarse = new Float64Array(this.coarse);
  }

  // With the poles, whose normal is that of the ring next to them.
  normal(i, j) {
    const pole = i === 0 || i === sketchRings - 1;
    let area = this.areas[j * sketchRings + i];
    if (pole)
      for (let around = 0; around < sketchColumns; ++around)
        area = combined([1, area], [1, this.areas[around * sketchRings + (i === 0 ? 1 : sketchRings - 2)]]);
    return unit(area);
  }
}

function addDisc(discs, place, area) {
  const size = Math.hypot(...area);
  if (size > 0) discs.push(...place, ...scaled(area, 1 / size), size);
}

// Shares that the discs hide: of the sky, weighted by the cosine, and of a wide lobe round the key light.
function hiddenBy(discs, [x, y, z], [nx, ny, nz], [kx, ky, kz]) {
  let sky = 0, sun = 0;
  for (let k = 0; k < discs.length; k += 7) {
    const dx = discs[k] - x, dy = discs[k + 1] - y, dz = discs[k + 2] - z, up = dx * nx + dy * ny + dz * nz;
    const facing = -(dx * discs[k + 3] + dy * discs[k + 4] + dz * discs[k + 5]);
    if (!(up > 0 && facing > 0)) continue;
    const r2 = dx * dx + dy * dy + dz * dz, spread = discs[k + 6] / (Math.PI * r2 + discs[k + 6]);
    sky += up * facing / r2 * spread;
    const along = dx * kx + dy * ky + dz * kz;
    if (along > 0) sun += 2.5 * (along * along / r2) ** 2 * facing / Math.sqrt(r2) * spread;
  }
  return [Math.min(sky, 1), Math.min(sun, 1)];
}

// Light at the vertices of a mesh of membrane `self`: two shares a vertex, open 0..1, after `strength`. key: towards the
// key light; fine: all discs count.
function shade(mesh, self, sketches, key, fine, strength, out) {
  const own = sketches[self], stride = fine ? 1 : 2, detail = fine ? "fine" : "coarse", neighbours = [];
  sketches.forEach((sketch, k) => {
    if (k === self) return;
    const reach = own.radius + sketch.radius, away = Math.hypot(...combined([1, own.centre], [-1, sketch.centre]));
    const share = 1 - smoothstep(1.3 * reach, 2.2 * reach, away);
    if (share > 0) neighbours.push({ discs: sketch[detail], share });
  });
  const rows = (sketchRings - 1) / stride + 1, columns = sketchColumns / stride, values = new Float64Array(2 * rows * columns);
  for (let j = 0; j < columns; ++j)
    for (let i = 0; i < rows; ++i) {
      const at = 2 * (j * rows + i);
      if (j > 0 && (i === 0 || i === rows - 1)) {
        values[at] = values[2 * i];
        values[at + 1] = values[2 * i + 1];
        continue;
      }
      const place = own.points[j * stride * sketchRings + i * stride], normal = own.normal(i * stride, j * stride);
      let [sky, sun] = hiddenBy(own[detail], place, normal, key).map(hidden => 1 - hidden);
      for (const { discs, share } of neighbours) {
        const hidden = hiddenBy(discs, place, normal, key);
        sky *= 1 - share * hidden[0];
        sun *= 1 - share * hidden[1];
      }
      values[at] = sky;
      values[at + 1] = sun;
    }
  spreadCubic(values, rows, columns, mesh, (vertex, sky, sun) => {
    const left = open => 1 - strength * (1 - Math.min(Math.max(open, 0), 1) ** 3);
    out[2 * vertex] = left(sky);
    out[2 * vertex + 1] = left(sun);
  });
}

// Weights of four values in a row for a place between the second and the third.
function cubicWeights(t) {
  return [t * (-1 + t * (2 - t)) / 2, 1 + t * t * (3 * t - 5) / 2, t * (1 + t * (4 - 3 * t)) / 2, t * t * (t - 1) / 2];
}

// Pairs of values on a net of rows of latitude, poles included, at all vertices of a mesh.
function spreadCubic(values, rows, columns, mesh, put) {
  const at = (i, j) => {  // beyond a pole the net goes on at the other side
    if (i < 0 || i > rows - 1) {
      i = i < 0 ? -i : 2 * (rows - 1) - i;
      j += columns / 2;
    }
    return 2 * (j % columns * rows + i);
  };
  const across = new Float64Array(2 * columns);
  for (let i = 0; i < mesh.rings; ++i) {
    const row = (i + 1) * (rows - 1) / mesh.latitudes, first = Math.floor(row), weights = cubicWeights(row - first);
    for (let j = 0; j < columns; ++j) {
      across[2 * j] = across[2 * j + 1] = 0;
      weights.forEach((w, a) => {
        const k = at(first + a - 1, j);
        across[2 * j] += w * values[k];
        across[2 * j + 1] += w * values[k + 1];
      });
    }
    for (let j = 0; j < mesh.longitudes; ++j) {
      const column = j * columns / mesh.longitudes, start = Math.floor(column), w = cubicWeights(column - start);
      let sky = 0, sun = 0;
      for (let b = 0; b < 4; ++b) {
        const k = 2 * ((start + b - 1 + columns) % columns);
        sky += w[b] * across[k];
        sun += w[b] * across[k + 1];
      }
      put(j * mesh.rings + i, sky, sun);
    }
  }
  put(mesh.vertices - 2, values[0], values[1]);
  put(mesh.vertices - 1, values[2 * (rows - 1)], values[2 * (rows - 1) + 1]);
}
