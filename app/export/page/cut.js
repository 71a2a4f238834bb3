// The plane that opens membranes, and the edges that it leaves; as make_cut() and draw_cut_edges() of the program.

// The centre of a membrane's volume, from its triangles; first: of its vertices in `position`.
function volumeCentre(mesh, position, first) {
  const { indices } = mesh, p = position, [ox, oy, oz] = p.subarray(3 * first, 3 * first + 3);
  let volume = 0, x = 0, y = 0, z = 0;
  for (let i = 0; i < indices.length; i += 3) {
    const a = 3 * (first + indices[i]), b = 3 * (first + indices[i + 1]), c = 3 * (first + indices[i + 2]);
    const ax = p[a] - ox, ay = p[a + 1] - oy, az = p[a + 2] - oz, bx = p[b] - ox, by = p[b + 1] - oy, bz = p[b + 2] - oz;
    const cx = p[c] - ox, cy = p[c + 1] - oy, cz = p[c + 2] - oz;
    const six = ax * (by * cz - bz * cy) + ay * (bz * cx - bx * cz) + az * (bx * cy - by * cx);
    volume += six;
    x += six * (ax + bx + cx) / 4;
    y += six * (ay + by + cy) / 4;
    z += six * (az + bz + cz) / 4;
  }
  return [ox + x / volume, oy + y / volume, oz + z / volume];
}

// Planes of all membranes: x, y, z and d of the half space normal . x + d > 0 that is taken away. through: what a common
// plane goes through, but for its offset.
function cutPlanes(mesh, position, count, { normal, offset, common }, through) {
  const plane = centre => [...normal, -dot(normal, centre) - offset];
  if (common) return new Array(count).fill(plane(through));
  return Array.from({ length: count }, (_, v) => plane(volumeCentre(mesh, position, v * mesh.vertices)));
}

// Closed curves where a membrane meets a plane, straight within each triangle.
function cutEdges(mesh, position, first, plane) {
  const { vertices, indices } = mesh, height = new Float64Array(vertices);
  for (let v = 0; v < vertices; ++v) {
    const k = 3 * (first + v);
    height[v] = plane[0] * position[k] + plane[1] * position[k + 1] + plane[2] * position[k + 2] + plane[3];
  }
  const points = [], neighbours = [], numbers = new Map();
  const crossing = (a, b) => {
    const low = Math.min(a, b), high = Math.max(a, b), key = low * vertices + high;
    if (!numbers.has(key)) {
      numbers.set(key, points.length);
      const share = height[low] / (height[low] - height[high]);
      points.push([0, 1, 2].map(c => (1 - share) * position[3 * (first + low) + c] + share * position[3 * (first + high) + c]));
      neighbours.push([]);
    }
    return numbers.get(key);
  };
  for (let i = 0; i < indices.length; i += 3) {
    const found = [];
    for (let k = 0; k < 3; ++k) {
      const a = indices[i + k], b = indices[i + (k + 1) % 3];
      if (height[a] >= 0 !== height[b] >= 0) found.push(crossing(a, b));
    }
    if (found.length < 2) continue;
    neighbours[found[0]].push(found[1]);
    neighbours[found[1]].push(found[0]);
  }
  // Each crossing belongs to two triangles, so following neighbours closes every curve.
  const curves = [], seen = new Uint8Array(points.length);
  for (let start = 0; start < points.length; ++start) {
    const curve = [];
    for (let at = start; at !== undefined && !seen[at]; at = neighbours[at].find(next => !seen[next])) {
      seen[at] = 1;
      curve.push(points[at]);
    }
    if (curve.length > 2) curves.push(curve);
  }
  return curves;
}
