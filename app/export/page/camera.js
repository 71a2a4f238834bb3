// The camera: three axes of the picture, a zoom and a shift. Lengths are area radii, relative to the point that the movie
// has in its middle.

const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
const combined = (...terms) => [0, 1, 2].map(k => terms.reduce((sum, [factor, v]) => sum + factor * v[k], 0));
const scaled = (a, factor) => combined([factor, a]);
const unit = a => scaled(a, 1 / (Math.hypot(...a) || 1));
const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];

class Camera {
  constructor(home) {
    this.home = home;
    this.reset();
  }

  reset(axes = this.home.axes) {
    this.axes = { right: [...axes.right], up: [...axes.up], back: [...axes.back] };
    this.zoom = 1;
    this.shift = [0, 0, 0];
  }

  // Neither turned nor moved.
  asFilmed() {
    const { axes, home, shift } = this;
    return dot(axes.right, home.axes.right) > 0.9999 && dot(axes.up, home.axes.up) > 0.9999 && Math.hypot(...shift) < 1e-3 * home.half_height;
  }

  // Radians about the upward and the rightward direction of the picture.
  turn(aboutUp, aboutRight) {
    const { right, up, back } = this.axes;
    const turned = (v, axis, angle) => combined([Math.cos(angle), v], [Math.sin(angle), cross(axis, v)],
                                                [(1 - Math.cos(angle)) * dot(axis, v), axis]);
    const both = v => turned(turned(v, up, aboutUp), right, aboutRight);
    this.axes.back = unit(both(back));
    this.axes.right = unit(cross(both(up), this.axes.back));
    this.axes.up = cross(this.axes.back, this.axes.right);
  }

  roll(angle) {
    const { right, up } = this.axes;
    this.axes.right = combined([Math.cos(angle), right], [Math.sin(angle), up]);
    this.axes.up = combined([Math.cos(angle), up], [-Math.sin(angle), right]);
  }

  magnify(factor) { this.zoom = Math.min(Math.max(this.zoom * factor, 0.05), 50); }

  // Shares of the picture's height.
  move(x, y, size) {
    const length = 2 * this.matrices(size).unit;
    this.shift = combined([1, this.shift], [-x * length, this.axes.right], [y * length, this.axes.up]);
  }

  // Column by column. A picture narrower than the movie's shows what happens in the movie, or its whole width.
  matrices(size) {
    const { home, zoom, axes } = this, aspect = size.width / size.height, fit = Math.max(1, Math.min(home.aspect, home.reach) / aspect);
    const base = home.half_height * fit, half = base / zoom;
    const reach = 4 * (Math.max(home.depth, base) + base * Math.max(1, aspect));
    const distance = home.perspective ? home.distance * fit / zoom : 2 * reach;
    const near = Math.max(distance - reach, 0.02 * distance), far = distance + reach;
    const { right, up, back } = axes;
    const view = new Float32Array(16);
    [right, up, back].forEach((axis, row) => {
      for (let k = 0; k < 3; ++k) view[4 * k + row] = axis[k] / half;
      view[12 + row] = -dot(axis, this.shift) / half;
    });
    view[14] -= distance / half;
    view[15] = 1;
    const projection = new Float32Array(16), n = near / half, f = far / half;
    if (home.perspective) {
      projection[0] = distance / half / aspect;
      projection[5] = distance / half;
      projection[10] = -(f + n) / (f - n);
      projection[11] = -1;
      projection[14] = -2 * f * n / (f - n);
    } else {
      projection[0] = 1 / aspect;
      projection[5] = 1;
      projection[10] = -2 / (f - n);
      projection[14] = -(f + n) / (f - n);
      projection[15] = 1;
    }
    return { view, projection, unit: half, fit, distance, depth: home.depth, perspective: home.perspective };
  }
}

// Where a point is seen, in half heights of the picture from its middle.
function placeOf({ view, projection }, point) {
  const eye = [0, 1, 2].map(r => view[r] * point[0] + view[4 + r] * point[1] + view[8 + r] * point[2] + view[12 + r]);
  const w = projection[11] * eye[2] + projection[15];
  return [projection[5] * eye[0] / w, projection[5] * eye[1] / w];
}
