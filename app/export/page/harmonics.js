"use strict";
// Real orthonormal spherical harmonics on a grid of latitudes and longitudes. The coefficient of Y_nm stands in row
// n (n + 1) + m; m < 0 is the sine of |m| phi.

// P_nm(theta) and its derivative for all n >= m >= 0 up to `order`, with the factors of the longitude; place(m) + n - m.
function legendre(order, theta) {
  const size = (order + 1) * (order + 2) / 2, value = new Float64Array(size), slope = new Float64Array(size);
  const place = m => m * (order + 1) - m * (m - 1) / 2;
  const cosine = Math.cos(theta), sine = Math.sin(theta);
  let diagonal = Math.SQRT1_2;
  for (let m = 0; m <= order; ++m) {
    if (m > 0) diagonal *= sine * Math.sqrt((2 * m + 1) / (2 * m));
    const at = place(m);
    value[at] = diagonal;
    let b = 0;
    for (let n = m + 1; n <= order; ++n) {
      const a = Math.sqrt((4 * n * n - 1) / (n * n - m * m));
      value[at + n - m] = a * (cosine * value[at + n - 1 - m] - b * (n - 2 >= m ? value[at + n - 2 - m] : 0));
      b = 1 / a;
    }
  }
  for (let m = 0; m <= order; ++m)
    for (let n = m; n <= order; ++n) {
      const up = n > m ? Math.sqrt((n - m) * (n + m + 1)) * value[place(m + 1) + n - m - 1] : 0;
      const down = m > 0 ? Math.sqrt((n + m) * (n - m + 1)) * value[place(m - 1) + n - m + 1] : up;
      slope[place(m) + n - m] = m > 0 ? (down - up) / 2 : -up;
    }
  for (let m = 0; m <= order; ++m) {
    const factor = m > 0 ? 1 / Math.sqrt(Math.PI) : 1 / Math.sqrt(2 * Math.PI);
    for (let k = place(m), end = k + order + 1 - m; k < end; ++k) {
      value[k] *= factor;
      slope[k] *= factor;
    }
  }
  return { value, slope };
}

const orderOf = (rows, fields) => Math.max(0, Math.ceil(Math.sqrt(Math.ceil(rows / fields)) - 1 - 1e-9));

// A mesh of the unit sphere: columns of longitude, `latitudes` - 1 vertices in each, and one vertex on each pole.
class Mesh {
  constructor(latitudes) {
    this.latitudes = latitudes;
    this.longitudes = 2 * latitudes;  // a multiple of 4
    this.rings = latitudes - 1;
    this.vertices = this.rings * this.longitudes + 2;
    this.tables = new Map();
    const { rings, longitudes: columns } = this, north = rings * columns, south = north + 1, corners = [];
    for (let j = 0; j < columns; ++j) {
      const here = j * rings, next = (j + 1) % columns * rings;
      corners.push(north, here, next);
      for (let i = 0; i + 1 < rings; ++i)
        corners.push(here + i, here + i + 1, next + i + 1, here + i, next + i + 1, next + i);
      corners.push(south, next + rings - 1, here + rings - 1);
    }
    this.indices = new Uint32Array(corners);
    this.parameters = new Float32Array(3 * this.vertices);
    for (let j = 0; j < columns; ++j)
      for (let i = 0; i < rings; ++i) {
        const theta = (i + 1) * Math.PI / latitudes, phi = j * Math.PI / latitudes;
        this.parameters.set([Math.sin(theta) * Math.cos(phi), Math.sin(theta) * Math.sin(phi), Math.cos(theta)],
                            3 * (j * rings + i));
      }
    this.parameters[3 * north + 2] = 1;
    this.parameters[3 * south + 2] = -1;
  }

  // The vertices that share an edge with vertex v, or a diagonal.
  neighbours(v, visit) {
    const { rings, longitudes: columns } = this, north = rings * columns, south = north + 1;
    if (v >= north) {
      for (let j = 0; j < columns; ++j) visit(j * rings + (v === north ? 0 : rings - 1));
      return;
    }
    const i = v % rings, j = Math.floor(v / rings);
    for (const column of [j, (j + 1) % columns, (j + columns - 1) % columns]) {
      if (column !== j) visit(column * rings + i);
      visit(i > 0 ? column * rings + i - 1 : north);
      visit(i + 1 < rings ? column * rings + i + 1 : south);
    }
  }

  table(order) {
    if (!this.tables.has(order)) {
      const rows = [], quarter = this.longitudes / 4 + 1;
      for (let i = 0; i <= this.latitudes; ++i) rows.push(legendre(order, i * Math.PI / this.latitudes));
      const cosine = new Float64Array((order + 1) * quarter), sine = new Float64Array((order + 1) * quarter);
      for (let m = 0; m <= order; ++m)
        for (let j = 0; j < quarter; ++j) {
          cosine[m * quarter + j] = Math.cos(m * j * Math.PI / this.latitudes);
          sine[m * quarter + j] = Math.sin(m * j * Math.PI / this.latitudes);
        }
      this.tables.set(order, { rows, cosine, sine, quarter });
    }
    return this.tables.get(order);
  }

  // sum of a_m cos(m phi) + b_m sin(m phi) at all longitudes of a ring, by the symmetries of a quarter turn.
  spread(a, b, order, fields, table, out, ring) {
    const { cosine, sine, quarter } = table, half = this.longitudes / 2, whole = this.longitudes, stride = this.rings * fields;
    for (let f = 0; f < fields; ++f) {
      const base = ring * fields + f;
      for (let j = 0; j < quarter; ++j) {
        let evenCosine = 0, oddCosine = 0, evenSine = 0, oddSine = 0;
        for (let m = 0; m <= order; m += 2) {
          evenCosine += a[m * fields + f] * cosine[m * quarter + j];
          evenSine += b[m * fields + f] * sine[m * quarter + j];
        }
        for (let m = 1; m <= order; m += 2) {
          oddCosine += a[m * fields + f] * cosine[m * quarter + j];
          oddSine += b[m * fields + f] * sine[m * quarter + j];
        }
        out[base + j * stride] = evenCosine + oddCosine + evenSine + oddSine;
        out[base + (half - j) * stride] = evenCosine - oddCosine - evenSine + oddSine;
        out[base + (half + j) % whole * stride] = evenCosine - oddCosine + evenSine - oddSine;
        out[base + (whole - j) % whole * stride] = evenCosine + oddCosine - evenSine - oddSine;
      }
    }
  }

  // Values at all vertices; with `slopes` also the derivatives in theta and phi on the rings, and at the poles the
  // tangents at phi = 0 and at phi = pi / 2 in their place.
  sample(coefficients, fields, out, slopes) {
    const order = orderOf(coefficients.length, fields), table = this.table(order), size = (order + 1) * fields;
    const a = new Float64Array(size), b = new Float64Array(size), da = new Float64Array(size), db = new Float64Array(size);
    const c = (n, m, f) => coefficients[(n * (n + 1) + m) * fields + f] || 0;
    for (let i = 0; i <= this.latitudes; ++i) {
      const { value, slope } = table.rows[i];
      let k = 0;
      for (let m = 0; m <= order; ++m) {
        const at = m * fields;
        for (let f = 0; f < fields; ++f) a[at + f] = b[at + f] = da[at + f] = db[at + f] = 0;
        for (let n = m; n <= order; ++n, ++k)
          for (let f = 0; f < fields; ++f) {
            const even = c(n, m, f), odd = m > 0 ? c(n, -m, f) : 0;
            a[at + f] += value[k] * even;
            b[at + f] += value[k] * odd;
            da[at + f] += slope[k] * even;
            db[at + f] += slope[k] * odd;
          }
      }
      if (i === 0 || i === this.latitudes) {
        const vertex = this.vertices - (i === 0 ? 2 : 1);
        for (let f = 0; f < fields; ++f) {
          out[vertex * fields + f] = a[f];
          if (!slopes) continue;
          slopes.theta[vertex * fields + f] = order > 0 ? da[fields + f] : 0;
          slopes.phi[vertex * fields + f] = (order > 0 ? db[fields + f] : 0) * (i === 0 ? 1 : -1);
        }
        continue;
      }
      this.spread(a, b, order, fields, table, out, i - 1);
      if (!slopes) continue;
      this.spread(da, db, order, fields, table, slopes.theta, i - 1);
      for (let m = 0; m <= order; ++m)
        for (let f = 0; f < fields; ++f) {
          const even = a[m * fields + f];
          a[m * fields + f] = m * b[m * fields + f];
          b[m * fields + f] = -m * even;
        }
      this.spread(a, b, order, fields, table, slopes.phi, i - 1);
    }
  }
}

// Point and outward normal of a surface at one direction of its parameter.
function surfacePoint(coefficients, direction) {
  const order = orderOf(coefficients.length, 3), length = Math.hypot(...direction) || 1;
  const sine = Math.max(Math.hypot(direction[0], direction[1]) / length, 1e-7);  // beside the axis the normal exists
  const phi = Math.atan2(direction[1], direction[0]);
  const { value, slope } = legendre(order, Math.atan2(sine, direction[2] / length));
  const point = [0, 0, 0], theta = [0, 0, 0], across = [0, 0, 0];
  for (let m = 0, k = 0; m <= order; ++m) {
    const cosine = Math.cos(m * phi), odd = Math.sin(m * phi);
    for (let n = m; n <= order; ++n, ++k)
      for (let f = 0; f < 3; ++f) {
        const a = coefficients[(n * (n + 1) + m) * 3 + f] || 0, b = m > 0 ? coefficients[(n * (n + 1) - m) * 3 + f] || 0 : 0;
        point[f] += value[k] * (a * cosine + b * odd);
        theta[f] += slope[k] * (a * cosine + b * odd);
        across[f] += value[k] * m * (b * cosine - a * odd);
      }
  }
  const normal = [theta[1] * across[2] - theta[2] * across[1], theta[2] * across[0] - theta[0] * across[2],
                  theta[0] * across[1] - theta[1] * across[0]];
  const size = Math.hypot(...normal) || 1;
  return { point, normal: normal.map(x => x / size) };
}
