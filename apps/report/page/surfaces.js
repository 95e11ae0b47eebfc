// SPDX-License-Identifier: MIT
// Surfaces and matches of the page as things to draw.
'use strict';

const surfaces = (() => {
  const colors = {source: 0x9db8d2, target: 0xd8cdb8, right: 0x009e73, wrong: 0xd55e00, missed: 0x8b949d};
  const identity = [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0];

  // Points are flat arrays x, y, z, x, ...; a motion is the twelve numbers of [R | t], row by row.
  function places(text, mesh) {
    const bytes = bytesOf(text), steps = new Uint16Array(bytes.buffer), points = new Float64Array(steps.length);
    for (let i = 0; i < steps.length; ++i)
      points[i] = mesh.low[i % 3] + (mesh.high[i % 3] - mesh.low[i % 3]) * steps[i] / 65535;
    return points;
  }
  function moved(points, m) {
    const result = new Float64Array(points.length);
    for (let i = 0; i < points.length; i += 3)
      for (let row = 0; row < 3; ++row)
        result[i + row] =
            m[4 * row] * points[i] + m[4 * row + 1] * points[i + 1] + m[4 * row + 2] * points[i + 2] + m[4 * row + 3];
    return result;
  }
  const turnOnly = m => m.map((value, i) => i % 4 === 3 ? 0 : value);
  /// a after b.
  function composed(a, b) {
    const columns =
        [0, 1, 2, 3].map(column => moved([b[column], b[4 + column], b[8 + column]], column < 3 ? turnOnly(a) : a));
    return [0, 1, 2].flatMap(row => columns.map(column => column[row]));
  }
  function boxOf(...clouds) {
    const low = [Infinity, Infinity, Infinity], high = [-Infinity, -Infinity, -Infinity];
    for (const points of clouds)
      for (let i = 0; i < points.length; ++i) {
        low[i % 3] = Math.min(low[i % 3], points[i]);
        high[i % 3] = Math.max(high[i % 3], points[i]);
      }
    return {low, high, size: high.map((h, axis) => h - low[axis]), middle: high.map((h, axis) => (h + low[axis]) / 2)};
  }

  function decode(mesh) {
    if (mesh.points) return mesh;
    mesh.points = places(mesh.vertices, mesh);
    mesh.corners = new Uint16Array(bytesOf(mesh.triangles).buffer);
    mesh.directions = Float64Array.from(new Int8Array(bytesOf(mesh.normals).buffer), value => value / 127);
    return mesh;
  }

  function decodeScene(scene) {
    if (scene.p) return scene;
    const source = decode(data.meshes[scene.source]), target = decode(data.meshes[scene.target]);
    scene.p = places(scene.source_points, source);
    scene.q = places(scene.target_points, target);
    scene.distance = scene.residuals === null ? null : new Float32Array(bytesOf(scene.residuals).buffer);
    scene.kept = Object.fromEntries(Object.entries(scene.selected).map(([method, bits]) => {
      const bytes = bytesOf(bits);
      return [method, Array.from({length: scene.matches}, (_, row) => (bytes[row >> 3] >> (row & 7) & 1) === 1)];
    }));
    return scene;
  }

  /// Without a truth it is unknown which matches are correct; then all selected ones are "kept".
  function split(scene, method, threshold) {
    const groups = {right: [], wrong: [], missed: [], kept: []};
    for (let row = 0; row < scene.matches; ++row) {
      const kept = (scene.kept[method] || [])[row], right = scene.distance ? scene.distance[row] <= threshold : null;
      if (right === null) {
        if (kept) groups.kept.push(row);
      } else if (kept)
        groups[right ? 'right' : 'wrong'].push(row);
      else if (right)
        groups.missed.push(row);
    }
    return groups;
  }

  function surface(mesh, motion, color) {
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute('position', new THREE.BufferAttribute(new Float32Array(moved(mesh.points, motion)), 3));
    if (mesh.corners.length === 0)
      return new THREE.Points(geometry, new THREE.PointsMaterial({color, size: 2, sizeAttenuation: false}));
    geometry.setAttribute(
        'normal', new THREE.BufferAttribute(new Float32Array(moved(mesh.directions, turnOnly(motion))), 3));
    geometry.setIndex(new THREE.BufferAttribute(mesh.corners, 1));
    return new THREE.Mesh(
        geometry, new THREE.MeshPhongMaterial({color, shininess: 12, specular: 0x222222, side: THREE.DoubleSide}));
  }

  function lines(name, rows, from, to) {
    const ends = new Float32Array(rows.length * 6);
    rows.forEach((row, i) => {
      ends.set(from.subarray(3 * row, 3 * row + 3), 6 * i);
      ends.set(to.subarray(3 * row, 3 * row + 3), 6 * i + 3);
    });
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute('position', new THREE.BufferAttribute(ends, 3));
    const color = colors[name] || 0x0b5cad;
    const drawn = new THREE.Group();
    drawn.add(new THREE.LineSegments(geometry, new THREE.LineBasicMaterial({
      color,
      transparent: true,
      opacity: Math.max(0.2, Math.min(0.8, 150 / rows.length)) * (name === 'missed' ? 0.6 : 1)
    })));
    if (name !== 'missed')
      drawn.add(new THREE.Points(geometry, new THREE.PointsMaterial({color, size: 4, sizeAttenuation: false})));
    drawn.children.forEach(part => {
      part.renderOrder = -rows.length;
    });  // the few over the many
    drawn.name = name;
    drawn.userData.count = rows.length;
    return drawn;
  }

  return {colors, identity, moved, turnOnly, composed, boxOf, decodeScene, split, surface, lines};
})();
