// SPDX-License-Identifier: MIT
// A pair in 3D: the two surfaces, the matches that one or two groupers kept, correct, incorrect and missed ones.
'use strict';

const pairView = (() => {
  const {colors, identity, moved, turnOnly, composed, boxOf, decodeScene, split, surface, lines} = surfaces;
  const scenes = data.scenes, keyOf = thing => `${thing.run}/${thing.selection}`;
  const sceneOf = new Map(scenes.map(scene => [keyOf(scene), scene]));
  const state = {scene: null, experiment: null, level: null};
  let renderer = null, camera, controls, halves = [], stale = false, home = 1;

  /// The threshold (pr) of a correct match in the records of a level.
  const thresholdOf = (experiment, level) =>
      experiment.attribute === 'threshold_pr' ? Number(level) : experiment.threshold_pr;

  /// The motion from the target to the screen: a scan is seen from its sensor, any other surface in the orientation of its
  /// source (without a truth: in its own), along z with y upwards.
  function viewOf(scene) {
    const mesh = data.meshes[scene.target], sum = [0, 0, 0];
    mesh.directions.forEach((value, i) => {
      sum[i % 3] += value;
    });
    const faces = Math.hypot(...sum) > 0.3 * mesh.directions.length / 3;
    const stand = axis => new THREE.Vector3(...moved(axis, turnOnly(scene.truth && !faces ? scene.truth : identity)));
    const out = faces ? new THREE.Vector3(...sum).normalize() : stand([0, 0, 1]), up = stand([0, 1, 0]);
    if (Math.abs(out.dot(up)) > 0.9) up.set(0, 0, -Math.sign(out.y));
    const right = up.clone().cross(out).normalize();
    up.copy(out).cross(right);
    const middle = boxOf(mesh.points).middle;
    return [right, up, out].flatMap(
        axis => [axis.x, axis.y, axis.z, -(axis.x * middle[0] + axis.y * middle[1] + axis.z * middle[2])]);
  }

  const poseOf = (scene, method, stage) => stage === 'truth' ? scene.truth : (scene.poses[method] || {})[stage] || null;

  /// The positions of the two surfaces on the screen: motions of source and target, and of the source's matches.
  function arrange(scene, method, aspect) {
    const source = data.meshes[scene.source], target = data.meshes[scene.target];
    const toScreen = viewOf(scene), pose = poseOf(scene, method, byId('stage').value);
    if (byId('layout').value === 'aligned') return {target: toScreen, source: pose && composed(toScreen, pose)};
    // Side by side the source has its true orientation (without a truth its own), so that both look alike.
    const turned = turnOnly(composed(turnOnly(toScreen), turnOnly(scene.truth || identity)));
    const a = boxOf(moved(source.points, turned)), b = boxOf(moved(target.points, toScreen));
    const gap = 0.2 * Math.min(a.size[0] + b.size[0], a.size[1] + b.size[1]);
    const wide = Math.min(aspect / (a.size[0] + b.size[0] + gap), 1 / Math.max(a.size[1], b.size[1]));
    const tall = Math.min(aspect / Math.max(a.size[0], b.size[0]), 1 / (a.size[1] + b.size[1] + gap));
    const along = wide >= tall ? 0 : 1, sign = along === 0 ? -1 : 1;
    const shift = b.middle.map(
        (middle, axis) =>
            middle - a.middle[axis] + (axis === along ? sign * ((a.size[axis] + b.size[axis]) / 2 + gap) : 0));
    return {target: toScreen, source: turned.map((value, i) => i % 4 === 3 ? value + shift[(i - 3) / 4] : value)};
  }

  function captionOf(scene, method, groups) {
    const record = records.find(
        r => keyOf(r) === keyOf(scene) && r.method === method && r.place === state.experiment &&
            r.level === state.level);
    const parts = [element('strong', {}, labelOf(method)), ' '];
    const say = (name, text) => parts.push(element('span', {class: name}, `${groups[name].length} ${text}`), ' · ');
    if (scene.distance) {
      say('right', 'right');
      say('wrong', 'wrong');
      say('missed', 'missed');
    } else
      parts.push(`${groups.kept.length} kept, not judged without a truth · `);
    const stage = byId('stage').value;
    if (record && isNumber(record[`${stage}_mean_error_pr`]))
      parts.push(`mean error ${fixed(record[`${stage}_mean_error_pr`], 2)} pr · `);
    if (!poseOf(scene, method, stage))
      parts.push(element('span', {class: 'bad'}, stage === 'truth' ? 'no truth' : 'no such pose'), ' · ');
    if (record)
      parts.push(`${record.excluded ? 'excluded; ' : ''}${record.status}`);
    else
      parts.pop();
    return parts;
  }

  function halfOf(scene, method, aspect) {
    const groups = split(scene, method, thresholdOf(state.experiment, state.level));
    const motions = arrange(scene, method, aspect), three = new THREE.Scene();
    const clouds = [];
    const put = (mesh, motion, color) => {
      three.add(surface(mesh, motion, color));
      clouds.push(moved(mesh.points, motion));
    };
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
    for (const half of halves)
      half.three.traverse(thing => {
        if (thing.geometry) {
          thing.geometry.dispose();
          thing.material.dispose();
        }
      });
    halves = [];
    const scene = state.scene;
    byId('left-caption').replaceChildren();
    byId('right-caption').replaceChildren();
    if (!scene || !renderer) return;
    const chosen = [byId('left-method').value, byId('right-method').value].filter(Boolean);
    halves = chosen.map(method => halfOf(scene, method, aspect(chosen.length)));
    halves.forEach(
        (half, i) =>
            byId(i ? 'right-caption' : 'left-caption').replaceChildren(...captionOf(scene, half.method, half.groups)));
    if (!keepView) resetView();
    stale = true;
  }

  const aspect = (count = halves.length) =>
      byId('view').clientWidth / Math.max(1, count) / Math.max(1, byId('view').clientHeight);

  function resetView() {
    if (!halves.length) return;
    const box = boxOf(...halves.map(half => [...half.box.low, ...half.box.high])),
          slope = Math.tan(camera.fov / 2 * Math.PI / 180);
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
    renderer.setClearColor(halves.length > 1 ? 0xdfe3e7 : 0xffffff);  // visible as a line between the halves
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
    controls.addEventListener('change', () => {
      stale = true;
    });
    canvas.addEventListener('mousedown', () => canvas.focus({preventScroll: true}));
    canvas.addEventListener('focus', () => {
      controls.noZoom = false;
    });  // else the wheel scrolls the page
    canvas.addEventListener('blur', () => {
      controls.noZoom = true;
    });
    canvas.addEventListener('keydown', onKey);
    new ResizeObserver(() => {
      controls.handleResize();
      build();
    }).observe(canvas);
    window.addEventListener('scroll', () => controls.handleResize(), {passive: true});
    const tick = () => {
      controls.update();
      if (stale) draw();
      requestAnimationFrame(tick);
    };
    tick();
  }

  /// As long as needed to tell the scenes apart.
  function nameOf(scene) {
    const parts = [scene.pair, scene.dataset, data.runs[scene.run].folder, scene.selection];
    const same = count => scenes
                              .filter(
                                  other => [other.pair, other.dataset, data.runs[other.run].folder, other.selection]
                                               .slice(0, count)
                                               .every((part, i) => part === parts[i]))
                              .length;
    return parts.slice(0, [2, 3].find(count => same(count) === 1) || 4).join(' · ');
  }

  function fillMethods(scene, left, right) {
    const known = methods.filter(method => method in scene.selected);
    byId('left-method').replaceChildren(...known.map(method => element('option', {value: method}, labelOf(method))));
    byId('right-method')
        .replaceChildren(
            element('option', {value: ''}, 'nothing'),
            ...known.map(method => element('option', {value: method}, labelOf(method))));
    byId('left-method').value = known.includes(left) ? left : known[0] || '';
    byId('right-method').value = known.includes(right) ? right : '';
  }

  /// Shows the scene of a record, if the page has it, with the record's grouper on the left.
  function show(record) {
    const scene = sceneOf.get(keyOf(record));
    Object.assign(state, {scene: null, experiment: record.place, level: record.level});
    byId('pair-view').hidden = !scene || Boolean(scene.problem);
    if (!scene || scene.problem) {
      byId('pair-note').textContent = record.selection === '' ?
          `${record.pair}: no selections in the study (${record.status}).` :
          scene ? `${record.pair} cannot be drawn: ${scene.problem}` :
                  `${record.pair} is not among the ${
                      scenes.length} pairs whose surfaces this page carries; its matches and selections are in ${
                      record.selection} of the run.`;
      return build();
    }
    const right = byId('right-method').value;
    state.scene = decodeScene(scene);
    byId('scene').value = keyOf(scene);
    fillMethods(scene, record.method, right === record.method ? '' : right);
    const mesh = which => data.meshes[scene[which]].full.toLocaleString('en');
    byId('pair-note')
        .replaceChildren(
            element('strong', {}, record.pair), ` (${scene.dataset}, level ${record.level}): `,
            element('span', {class: 'swatch', style: 'background: #9db8d2'}), `source, ${mesh('source')} vertices; `,
            element('span', {class: 'swatch', style: 'background: #d8cdb8'}),
            `target, ${mesh('target')} vertices; ${counted(scene.matches, 'match', 'matches')}`);
    for (const option of byId('stage').options)
      option.disabled =
          option.value === 'truth' ? !scene.truth : !Object.values(scene.poses).some(poses => option.value in poses);
    build();
  }

  function start(onScene) {
    byId('scene').replaceChildren(...scenes.map(scene => element('option', {value: keyOf(scene)}, nameOf(scene))));
    open3d();
    byId('scene').addEventListener('change', () => onScene(records.find(r => keyOf(r) === byId('scene').value)));
    for (const id of ['left-method', 'right-method', 'layout', 'stage'])
      byId(id).addEventListener('change', () => build());
    for (const id of ['show-right', 'show-wrong', 'show-missed'])
      byId(id).addEventListener('change', () => build(true));
    byId('reset-view').addEventListener('click', resetView);
  }

  return {start, show, has: record => sceneOf.has(keyOf(record)), state, halves: () => halves, camera: () => camera};
})();
