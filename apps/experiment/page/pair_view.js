// SPDX-License-Identifier: MIT
// A pair in 3D: the two surfaces, the matches that one grouper or two kept, right ones, wrong ones and missed ones.
'use strict';

const pairView = (() => {
  const colors = {source: 0x9db8d2, target: 0xd8cdb8, right: 0x009e73, wrong: 0xd55e00, missed: 0x8b949d};
  const scenes = data.scenes, keyOf = thing => `${thing.run}/${thing.selection}`;
  const sceneOf = new Map(scenes.map(scene => [keyOf(scene), scene]));
  const state = {scene: null, experiment: null, level: null};
  const identity = [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0];
  let renderer = null, camera, controls, halves = [], stale = false, home = 1;

  // Points are flat arrays x, y, z, x, ...; a motion is the twelve numbers of [R | t], row by row.
  function places(text, mesh) {
    const bytes = bytesOf(text), steps = new Uint16Array(bytes.buffer), points = new Float64Array(steps.length);
    for (let i = 0; i < steps.length; ++i) points[i] = mesh.low[i % 3] + (mesh.high[i % 3] - mesh.low[i % 3]) * steps[i] / 65535;
    return points;
  }
  function moved(points, m) {
    const result = new Float64Array(points.length);
    for (let i = 0; i < points.length; i += 3)
      for (let row = 0; row < 3; ++row)
        result[i + row] = m[4 * row] * points[i] + m[4 * row + 1] * points[i + 1] + m[4 * row + 2] * points[i + 2] + m[4 * row + 3];
    return result;
  }
  const turnOnly = m => m.map((value, i) => i % 4 === 3 ? 0 : value);
  /// a after b.
  function composed(a, b) {
    const columns = [0, 1, 2, 3].map(column => moved([b[column], b[4 + column], b[8 + column]], column < 3 ? turnOnly(a) : a));
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

  /// Within how many pr a match was right for the records of a level.
  const thresholdOf = (experiment, level) => experiment.attribute === 'threshold_pr' ? Number(level) : experiment.threshold_pr;

  /// What is right is unknown without a truth; then all that was kept counts as "kept".
  function split(scene, method, threshold) {
    const groups = {right: [], wrong: [], missed: [], kept: []};
    for (let row = 0; row < scene.matches; ++row) {
      const kept = (scene.kept[method] || [])[row], right = scene.distance ? scene.distance[row] <= threshold : null;
      if (right === null) { if (kept) groups.kept.push(row); }
      else if (kept) groups[right ? 'right' : 'wrong'].push(row);
      else if (right) groups.missed.push(row);
    }
    return groups;
  }

  /// Looks a scan into its face, and any other surface as its source stands (or it stands itself, without a truth), along
  /// its z with y upwards: the motion from the target to the screen.
  function viewOf(scene) {
    const mesh = data.meshes[scene.target], sum = [0, 0, 0];
    mesh.directions.forEach((value, i) => { sum[i % 3] += value; });
    const faces = Math.hypot(...sum) > 0.3 * mesh.directions.length / 3;
    const stand = axis => new THREE.Vector3(...moved(axis, turnOnly(scene.truth && !faces ? scene.truth : identity)));
    const out = faces ? new THREE.Vector3(...sum).normalize() : stand([0, 0, 1]), up = stand([0, 1, 0]);
    if (Math.abs(out.dot(up)) > 0.9) up.set(0, 0, -Math.sign(out.y));
    const right = up.clone().cross(out).normalize();
    up.copy(out).cross(right);
    const middle = boxOf(mesh.points).middle;
    return [right, up, out].flatMap(axis => [axis.x, axis.y, axis.z, -(axis.x * middle[0] + axis.y * middle[1] + axis.z * middle[2])]);
  }

  function surface(mesh, motion, color) {
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute('position', new THREE.BufferAttribute(new Float32Array(moved(mesh.points, motion)), 3));
    if (mesh.corners.length === 0)
      return new THREE.Points(geometry, new THREE.PointsMaterial({color, size: 2, sizeAttenuation: false}));
    geometry.setAttribute('normal', new THREE.BufferAttribute(new Float32Array(moved(mesh.directions, turnOnly(motion))), 3));
    geometry.setIndex(new THREE.BufferAttribute(mesh.corners, 1));
    return new THREE.Mesh(geometry, new THREE.MeshPhongMaterial({color, shininess: 12, specular: 0x222222, side: THREE.DoubleSide}));
  }

  function lines(name, rows, from, to) {
    const ends = new Float32Array(rows.length * 6);
    rows.forEach((row, i) => { ends.set(from.subarray(3 * row, 3 * row + 3), 6 * i); ends.set(to.subarray(3 * row, 3 * row + 3), 6 * i + 3); });
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute('position', new THREE.BufferAttribute(ends, 3));
    const color = colors[name] || 0x0b5cad;
    const drawn = new THREE.Group();
    drawn.add(new THREE.LineSegments(geometry, new THREE.LineBasicMaterial({color, transparent: true, opacity: Math.max(0.2, Math.min(0.8, 150 / rows.length)) * (name === 'missed' ? 0.6 : 1)})));
    if (name !== 'missed') drawn.add(new THREE.Points(geometry, new THREE.PointsMaterial({color, size: 4, sizeAttenuation: false})));
    drawn.children.forEach(part => { part.renderOrder = -rows.length; });  // the few over the many
    drawn.name = name;
    drawn.userData.count = rows.length;
    return drawn;
  }

  const poseOf = (scene, method, stage) => stage === 'truth' ? scene.truth : (scene.poses[method] || {})[stage] || null;

  /// Where the two surfaces go on the screen: motions of source and target, and the source's place for its matches.
  function arrange(scene, method, aspect) {
    const source = data.meshes[scene.source], target = data.meshes[scene.target];
    const toScreen = viewOf(scene), pose = poseOf(scene, method, byId('stage').value);
    if (byId('layout').value === 'aligned') return {target: toScreen, source: pose && composed(toScreen, pose)};
    // Side by side the source is turned as the truth has it (or else as it is), so that like lies beside like.
    const turned = turnOnly(composed(turnOnly(toScreen), turnOnly(scene.truth || identity)));
    const a = boxOf(moved(source.points, turned)), b = boxOf(moved(target.points, toScreen));
    const gap = 0.2 * Math.min(a.size[0] + b.size[0], a.size[1] + b.size[1]);
    const wide = Math.min(aspect / (a.size[0] + b.size[0] + gap), 1 / Math.max(a.size[1], b.size[1]));
    const tall = Math.min(aspect / Math.max(a.size[0], b.size[0]), 1 / (a.size[1] + b.size[1] + gap));
    const along = wide >= tall ? 0 : 1, sign = along === 0 ? -1 : 1;
    const shift = b.middle.map((middle, axis) => middle - a.middle[axis] + (axis === along ? sign * ((a.size[axis] + b.size[axis]) / 2 + gap) : 0));
    return {target: toScreen, source: turned.map((value, i) => i % 4 === 3 ? value + shift[(i - 3) / 4] : value)};
  }

  function captionOf(scene, method, groups) {
    const record = records.find(r => keyOf(r) === keyOf(scene) && r.method === method && r.place === state.experiment && r.level === state.level);
    const parts = [element('strong', {}, labelOf(method)), ' '];
    const say = (name, text) => parts.push(element('span', {class: name}, `${groups[name].length} ${text}`), ' · ');
    if (scene.distance) { say('right', 'right'); say('wrong', 'wrong'); say('missed', 'missed'); }
    else parts.push(`${groups.kept.length} kept, no truth to judge them · `);
    const stage = byId('stage').value;
    if (record && isNumber(record[`${stage}_rmse_pr`])) parts.push(`RMSE ${fixed(record[`${stage}_rmse_pr`], 2)} pr · `);
    if (!poseOf(scene, method, stage)) parts.push(element('span', {class: 'bad'}, stage === 'truth' ? 'no truth' : 'no such pose'), ' · ');
    if (record) parts.push(`${record.excluded ? 'excluded; ' : ''}${record.status}`); else parts.pop();
    return parts;
  }

  function halfOf(scene, method, aspect) {
    const groups = split(scene, method, thresholdOf(state.experiment, state.level));
    const motions = arrange(scene, method, aspect), three = new THREE.Scene();
    const clouds = [];
    const put = (mesh, motion, color) => { three.add(surface(mesh, motion, color)); clouds.push(moved(mesh.points, motion)); };
    put(data.meshes[scene.target], motions.target, colors.target);
    if (motions.source) {
      put(data.meshes[scene.source], motions.source, colors.source);
      const from = moved(scene.p, motions.source), to = moved(scene.q, motions.target);
      for (const name of ['kept', 'missed', 'right', 'wrong']) {
        const box = byId(`show-${name}`);
        if (groups[name].length && (!box || box.checked)) three.add(lines(name, groups[name], from, to));
      }
    }
    three.add(new THREE.HemisphereLight(0xffffff, 0x8a8f96, 0.55));
    const lamp = new THREE.DirectionalLight(0xffffff, 0.6);
    three.add(lamp, lamp.target);
    return {method, groups, three, lamp, box: boxOf(...clouds)};
  }

  function build(keepView = false) {
    for (const half of halves) half.three.traverse(thing => { if (thing.geometry) { thing.geometry.dispose(); thing.material.dispose(); } });
    halves = [];
    const scene = state.scene;
    byId('left-caption').replaceChildren();
    byId('right-caption').replaceChildren();
    if (!scene || !renderer) return;
    const chosen = [byId('left-method').value, byId('right-method').value].filter(Boolean);
    halves = chosen.map(method => halfOf(scene, method, aspect(chosen.length)));
    halves.forEach((half, i) => byId(i ? 'right-caption' : 'left-caption').replaceChildren(...captionOf(scene, half.method, half.groups)));
    if (!keepView) resetView();
    stale = true;
  }

  const aspect = (count = halves.length) => byId('view').clientWidth / Math.max(1, count) / Math.max(1, byId('view').clientHeight);

  function resetView() {
    if (!halves.length) return;
    const box = halves[0].box, slope = Math.tan(camera.fov / 2 * Math.PI / 180);
    home = 1.06 * Math.max(box.size[1] / 2 / slope, box.size[0] / 2 / slope / aspect()) + box.size[2] / 2;
    controls.reset();
    controls.target.set(...box.middle);
    camera.up.set(0, 1, 0);
    camera.position.set(box.middle[0], box.middle[1], box.middle[2] + home);
    camera.near = home / 20;
    camera.far = home * 20;
    controls.update();
    stale = true;
  }

  function draw() {
    const canvas = byId('view'), width = canvas.clientWidth / Math.max(1, halves.length);
    renderer.setSize(canvas.clientWidth, canvas.clientHeight, false);
    renderer.setScissorTest(false);
    renderer.setClearColor(halves.length > 1 ? 0xdfe3e7 : 0xffffff);  // what stays of it parts the halves
    renderer.clear();
    renderer.setScissorTest(true);
    renderer.setClearColor(0xffffff);
    camera.aspect = aspect();
    camera.updateProjectionMatrix();
    halves.forEach((half, i) => {
      renderer.setViewport(i * width, 0, width, canvas.clientHeight);
      renderer.setScissor(i * width + i, 0, width - i, canvas.clientHeight);
      half.lamp.position.copy(camera.position);
      half.lamp.target.position.copy(controls.target);
      renderer.render(half.three, camera);
    });
    stale = false;
  }

  function onKey(event) {
    const turn = {ArrowLeft: [0, -1], ArrowRight: [0, 1], ArrowUp: [1, -1], ArrowDown: [1, 1]}[event.key];
    const scale = {'+': 0.85, '=': 0.85, '-': 1 / 0.85}[event.key];
    if (event.key === '0') return resetView();
    if (!turn && !scale) return;
    event.preventDefault();
    const arm = camera.position.clone().sub(controls.target);
    if (scale) arm.multiplyScalar(scale);
    if (turn) {
      const axis = turn[0] ? camera.up.clone().cross(arm).normalize() : camera.up.clone();
      arm.applyAxisAngle(axis, turn[1] * Math.PI / 18);
      camera.up.applyAxisAngle(axis, turn[1] * Math.PI / 18);
    }
    camera.position.copy(controls.target).add(arm);
    controls.update();
    stale = true;
  }

  function open3d() {
    const canvas = byId('view');
    try {
      renderer = new THREE.WebGLRenderer({canvas, antialias: true, preserveDrawingBuffer: true});
    } catch (error) {
      byId('pair-note').textContent = 'This browser offers no WebGL: the surfaces cannot be shown.';
      byId('pair-view').hidden = true;
      return;
    }
    renderer.setPixelRatio(Math.min(2, window.devicePixelRatio));
    camera = new THREE.PerspectiveCamera(10, 1, 0.1, 100);
    controls = new THREE.TrackballControls(camera, canvas);
    Object.assign(controls, {staticMoving: true, keys: [], rotateSpeed: 2.5, noZoom: true});
    controls.addEventListener('change', () => { stale = true; });
    canvas.addEventListener('mousedown', () => canvas.focus({preventScroll: true}));
    canvas.addEventListener('focus', () => { controls.noZoom = false; });  // a wheel that only passes by scrolls the page
    canvas.addEventListener('blur', () => { controls.noZoom = true; });
    canvas.addEventListener('keydown', onKey);
    new ResizeObserver(() => { controls.handleResize(); build(); }).observe(canvas);
    window.addEventListener('scroll', () => controls.handleResize(), {passive: true});
    const tick = () => { controls.update(); if (stale) draw(); requestAnimationFrame(tick); };
    tick();
  }

  /// As long as it must be to tell the scenes apart.
  function nameOf(scene) {
    const parts = [scene.pair, scene.dataset, data.runs[scene.run].folder, scene.selection];
    const same = count => scenes.filter(other => [other.pair, other.dataset, data.runs[other.run].folder, other.selection].slice(0, count)
      .every((part, i) => part === parts[i])).length;
    return parts.slice(0, [2, 3].find(count => same(count) === 1) || 4).join(' · ');
  }

  function fillMethods(scene, left, right) {
    const known = methods.filter(method => method in scene.selected);
    byId('left-method').replaceChildren(...known.map(method => element('option', {value: method}, labelOf(method))));
    byId('right-method').replaceChildren(element('option', {value: ''}, 'nothing'), ...known.map(method => element('option', {value: method}, labelOf(method))));
    byId('left-method').value = known.includes(left) ? left : known[0] || '';
    byId('right-method').value = known.includes(right) ? right : '';
  }

  /// Shows the scene of a record, if the page has it, with the record's grouper on the left.
  function show(record) {
    const scene = sceneOf.get(keyOf(record));
    Object.assign(state, {scene: null, experiment: record.place, level: record.level});
    byId('pair-view').hidden = !scene || Boolean(scene.problem);
    if (!scene || scene.problem) {
      byId('pair-note').textContent = record.selection === '' ? `${record.pair}: nothing was matched, so there is nothing to draw (${record.status}).`
        : scene ? `${record.pair} cannot be drawn: ${scene.problem}`
        : `${record.pair} is not among the ${scenes.length} pairs whose surfaces this page carries; its matches and selections are in ${record.selection} of the run.`;
      return build();
    }
    const right = byId('right-method').value;
    state.scene = decodeScene(scene);
    byId('scene').value = keyOf(scene);
    fillMethods(scene, record.method, right === record.method ? '' : right);
    const mesh = which => data.meshes[scene[which]].full.toLocaleString('en');
    byId('pair-note').replaceChildren(element('strong', {}, record.pair), ` (${scene.dataset}, level ${record.level}): `,
      element('span', {class: 'swatch', style: 'background: #9db8d2'}), `source, ${mesh('source')} vertices; `,
      element('span', {class: 'swatch', style: 'background: #d8cdb8'}), `target, ${mesh('target')} vertices; ${counted(scene.matches, 'match', 'matches')}`);
    for (const option of byId('stage').options)
      option.disabled = option.value === 'truth' ? !scene.truth : !Object.values(scene.poses).some(poses => option.value in poses);
    build();
  }

  function start(onScene) {
    byId('scene').replaceChildren(...scenes.map(scene => element('option', {value: keyOf(scene)}, nameOf(scene))));
    open3d();
    byId('scene').addEventListener('change', () => onScene(records.find(r => keyOf(r) === byId('scene').value)));
    for (const id of ['left-method', 'right-method', 'layout', 'stage']) byId(id).addEventListener('change', () => build());
    for (const id of ['show-right', 'show-wrong', 'show-missed']) byId(id).addEventListener('change', () => build(true));
    byId('reset-view').addEventListener('click', resetView);
  }

  return {start, show, has: record => sceneOf.has(keyOf(record)), state, halves: () => halves, camera: () => camera};
})();
