// How far vertices are seen from the contour of their membrane: where it is nearly edge-on without turning over there is
// none, though it looks so to a shader; as contour_distances() of the program.

// unit: samples of a half height; beyond `reach` samples only that it is farther counts. first: of the membrane's
// vertices in `position` and `normal`.
function contourDistances(mesh, position, normal, first, camera, unit, reach, out) {
  const { vertices, indices } = mesh, { view, projection } = camera;
  const facing = new Float32Array(vertices), seen = new Float32Array(2 * vertices);
  for (let v = 0; v < vertices; ++v) {
    const k = 3 * (first + v), x = position[k], y = position[k + 1], z = position[k + 2];
    const eye = [0, 1, 2].map(r => view[r] * x + view[4 + r] * y + view[8 + r] * z + view[12 + r]);
    const n = [0, 1, 2].map(r => view[r] * normal[k] + view[4 + r] * normal[k + 1] + view[8 + r] * normal[k + 2]);
    const toward = camera.perspective ? -(n[0] * eye[0] + n[1] * eye[1] + n[2] * eye[2]) / (Math.hypot(...eye) || 1) : n[2];
    facing[v] = toward / (Math.hypot(...n) || 1);
    const w = projection[11] * eye[2] + projection[15];
    seen[2 * v] = unit * projection[5] * eye[0] / w;
    seen[2 * v + 1] = unit * projection[5] * eye[1] / w;
  }
  const far = 4 * reach, source = new Uint32Array(vertices), front = [], pieces = [];
  out.fill(far, first, first + vertices);
  const offer = (v, piece) => {
    const x = seen[2 * v], y = seen[2 * v + 1], fx = pieces[piece], fy = pieces[piece + 1], ax = pieces[piece + 2], ay = pieces[piece + 3];
    const share = Math.min(Math.max(((x - fx) * ax + (y - fy) * ay) / (ax * ax + ay * ay), 0), 1);
    const d = Math.fround(Math.hypot(x - fx - share * ax, y - fy - share * ay));  // as it is stored, or this may not end
    if (d >= out[first + v]) return;
    out[first + v] = d;
    source[v] = piece;
    if (d < reach) front.push(v);
  };
  for (let i = 0; i < indices.length; i += 3) {
    const back = [0, 1, 2].map(k => facing[indices[i + k]] < 0);
    if (back[0] === back[1] && back[0] === back[2]) continue;
    const crossings = [];
    for (let k = 0; k < 3; ++k) {
      const a = indices[i + k], b = indices[i + (k + 1) % 3];
      if (back[k] === back[(k + 1) % 3]) continue;
      const share = facing[a] / (facing[a] - facing[b]);
      crossings.push([seen[2 * a] + share * (seen[2 * b] - seen[2 * a]), seen[2 * a + 1] + share * (seen[2 * b + 1] - seen[2 * a + 1])]);
    }
    // longer by itself at both ends: what is beside an end may never hear of the next piece
    const [from, to] = crossings, x = to[0] - from[0], y = to[1] - from[1];
    if (Math.hypot(x, y) < 0.02) continue;  // samples: one that only touches the contour has no direction
    pieces.push(from[0] - x, from[1] - y, 3 * x, 3 * y);
    for (let k = 0; k < 3; ++k) offer(indices[i + k], pieces.length - 4);
  }
  // Neighbours of vertices that are near are offered the same piece of the contour; who comes nearer offers it again.
  for (let k = 0; k < front.length; ++k) {
    const piece = source[front[k]];
    mesh.neighbours(front[k], v => offer(v, piece));
  }
}

// Vertex indices of the triangles at the rim of a membrane, counted from `first`, into `out` from `at` on; as
// rim_triangles() of the program. reach: half heights. Returns the end.
function rimTriangles(mesh, position, normal, first, camera, reach, out, at) {
  const narrowest = 0.3, frontEnough = 0.1, { vertices, indices } = mesh, { view, perspective } = camera;
  const eye = new Float32Array(3 * vertices), facing = new Float32Array(vertices);
  let farthest = 0;
  for (let v = 0; v < vertices; ++v) {
    const k = 3 * (first + v), x = position[k], y = position[k + 1], z = position[k + 2], nx = normal[k], ny = normal[k + 1], nz = normal[k + 2];
    const ex = view[0] * x + view[4] * y + view[8] * z + view[12], ey = view[1] * x + view[5] * y + view[9] * z + view[13],
          ez = view[2] * x + view[6] * y + view[10] * z + view[14];
    const mx = view[0] * nx + view[4] * ny + view[8] * nz, my = view[1] * nx + view[5] * ny + view[9] * nz, mz = view[2] * nx + view[6] * ny + view[10] * nz;
    eye[3 * v] = ex;
    eye[3 * v + 1] = ey;
    eye[3 * v + 2] = ez;
    farthest = Math.max(farthest, -ez);
    const toward = perspective ? -(mx * ex + my * ey + mz * ez) / (Math.sqrt(ex * ex + ey * ey + ez * ez) || 1) : mz;
    facing[v] = toward / (Math.sqrt(mx * mx + my * my + mz * mz) || 1);
  }
  const scale = perspective ? farthest / (camera.distance / camera.unit) : 1;
  const square = (array, a, b) => (array[b] - array[a]) ** 2 + (array[b + 1] - array[a + 1]) ** 2 + (array[b + 2] - array[a + 2]) ** 2;
  for (let cosine = narrowest;;) {
    let end = at, bent = 0;  // the square of the largest curvature
    const bend = (a, b) => {
      const length = square(eye, 3 * a, 3 * b);
      if (length > 0) bent = Math.max(bent, square(normal, 3 * (first + a), 3 * (first + b)) / length);
    };
    for (let i = 0; i < indices.length; i += 3) {
      const a = indices[i], b = indices[i + 1], c = indices[i + 2], fa = facing[a], fb = facing[b], fc = facing[c];
      if (Math.max(fa, fb, fc) <= -cosine || Math.min(fa, fb, fc) >= frontEnough) continue;
      out[end++] = first + a;
      out[end++] = first + b;
      out[end++] = first + c;
      bend(a, b);
      bend(b, c);
    }
    if (cosine > 1) return end;  // all back faces
    const curvature = Math.sqrt(bent) + (perspective ? 1 / farthest : 0), inside = 1 - curvature * reach * scale;
    const needed = inside > 0 ? Math.sqrt(1 - inside * inside) : 2;
    if (needed <= cosine) return end;
    cosine = needed;
  }
}
