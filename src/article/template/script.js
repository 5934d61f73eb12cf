'use strict';
// Adds to a page that is complete without it: layers, zoom and read-out of figures, and the slider over k.
(() => {
  const make = (tag, attributes, parent, text) => {
    const element = document.createElement(tag);
    Object.entries(attributes).forEach(([name, value]) => element.setAttribute(name, value));
    if (text !== undefined) element.textContent = text;
    parent.append(element);
    return element;
  };
  const draw = (tag, attributes, parent) => {
    const element = document.createElementNS('http://www.w3.org/2000/svg', tag);
    Object.entries(attributes).forEach(([name, value]) => element.setAttribute(name, value));
    parent.append(element);
    return element;
  };
  const FIXED = new Set(['axes', 'axis-text', 'labels', 'inset', 'legend', 'panel']);

  const layers = (figure, svg, tools) => {
    const roles = new Map();
    svg.querySelectorAll('g[data-role]').forEach((group) => {
      const role = group.dataset.role;
      if (!FIXED.has(role)) roles.set(role, [...(roles.get(role) ?? []), group]);
    });
    if (roles.size < 2) return;
    for (const [role, groups] of roles) {
      const label = make('label', {}, tools);
      const box = make('input', { type: 'checkbox', 'data-layer': role }, label);
      box.checked = true;
      label.append(` ${role.replaceAll('-', ' ')}`);
      box.addEventListener('change', () => groups.forEach((group) => { group.style.display = box.checked ? '' : 'none'; }));
    }
  };

  const zoom = (svg, tools) => {
    const whole = svg.viewBox.baseVal;
    const start = { x: whole.x, y: whole.y, width: whole.width, height: whole.height };
    let view = { ...start };
    const show = () => svg.setAttribute('viewBox', `${view.x} ${view.y} ${view.width} ${view.height}`);
    const by = (factor, at = { x: view.x + view.width / 2, y: view.y + view.height / 2 }) => {
      const width = Math.min(start.width, Math.max(start.width / 400, view.width * factor));
      const scale = width / view.width;
      view = { x: at.x - (at.x - view.x) * scale, y: at.y - (at.y - view.y) * scale, width, height: view.height * scale };
      if (width === start.width) view = { ...start };
      show();
    };
    const point = (event) => new DOMPoint(event.clientX, event.clientY).matrixTransform(svg.getScreenCTM().inverse());
    make('button', { type: 'button', 'aria-label': 'zoom in' }, tools, '+').addEventListener('click', () => by(1 / 1.6));
    make('button', { type: 'button', 'aria-label': 'zoom out' }, tools, '−').addEventListener('click', () => by(1.6));
    make('button', { type: 'button' }, tools, 'whole').addEventListener('click', () => { view = { ...start }; show(); });
    svg.addEventListener('dblclick', (event) => by(event.shiftKey ? 2 : 0.5, point(event)));
    let held = null;
    svg.addEventListener('pointerdown', (event) => { if (view.width < start.width) { held = point(event); svg.setPointerCapture(event.pointerId); } });
    svg.addEventListener('pointermove', (event) => {
      if (!held) return;
      const now = point(event);
      view = { ...view, x: view.x + held.x - now.x, y: view.y + held.y - now.y };
      show();
    });
    svg.addEventListener('pointerup', () => { held = null; });
    return point;
  };

  const readout = (svg, point, tools) => {
    const frames = [...svg.querySelectorAll('[data-frame]')].map((group) => ({
      box: group.dataset.frame.split(' ').map(Number),
      x: group.dataset.x.split(' '), y: group.dataset.y.split(' '),
    }));
    if (!frames.length) return;
    const text = make('span', { class: 'readout', 'aria-live': 'off' }, tools);
    const value = (range, part) => {
      const [low, high] = [Number(range[0]), Number(range[1])];
      const at = low + (high - low) * part;
      return range[2] === 'log' ? 10 ** at : at;
    };
    svg.addEventListener('pointermove', (event) => {
      const at = point(event);
      const inside = frames.filter(({ box }) => at.x >= box[0] && at.x <= box[2] && at.y >= box[1] && at.y <= box[3]);
      const frame = inside.at(-1);
      if (!frame) { text.textContent = ''; return; }
      const { box } = frame;
      const x = value(frame.x, (at.x - box[0]) / (box[2] - box[0]));
      const y = value(frame.y, (box[3] - at.y) / (box[3] - box[1]));
      text.textContent = `(${x.toPrecision(5)}, ${y.toPrecision(5)})`;
    });
    svg.addEventListener('pointerleave', () => { text.textContent = ''; });
  };

  document.querySelectorAll('figure[data-figure]').forEach((figure) => {
    const svg = figure.querySelector('svg');
    const tools = make('div', { class: 'tools', role: 'group', 'aria-label': 'layers and zoom' }, figure);
    figure.insertBefore(tools, figure.querySelector('figcaption'));
    layers(figure, svg, tools);
    readout(svg, zoom(svg, tools), tools);
  });

  const data = JSON.parse(document.getElementById('loci').textContent);
  if (!data) return;
  const slider = document.getElementById('slider');
  slider.hidden = false;
  const [input, output, play] = ['slider-k', 'slider-value', 'slider-play'].map((id) => document.getElementById(id));
  input.max = data.k.length - 1;
  input.value = Math.max(0, data.k.indexOf(1));
  const UNIT = 1e4;
  const [LOCUS, EQUATOR, GREY] = ['#d55e00', '#646464', '#808080'];

  const plane = document.getElementById('slider-plane');
  plane.setAttribute('viewBox', '-6.2 -4 12.4 8');
  draw('line', { x1: -5.2, x2: 5.2, y1: 0, y2: 0, stroke: EQUATOR, 'stroke-width': 0.02 }, plane);
  for (const [x, text] of [[-Math.PI, '−π'], [0, '0'], [Math.PI, 'π']]) {
    draw('line', { x1: x, x2: x, y1: -Math.PI / 2, y2: Math.PI / 2, stroke: GREY, 'stroke-width': 0.015, 'stroke-dasharray': '0.08 0.08' }, plane);
    draw('text', { x, y: 1.95, 'font-size': 0.32, 'text-anchor': 'middle' }, plane).textContent = text;
  }
  for (const [y, text] of [[-Math.PI / 2, '0'], [0, 'π/2'], [Math.PI / 2, 'π']]) {
    draw('text', { x: -5.25, y: y + 0.1, 'font-size': 0.32, 'text-anchor': 'end' }, plane).textContent = text;
  }
  draw('text', { x: 4.6, y: 2.5, 'font-size': 0.36, 'font-style': 'italic' }, plane).textContent = 'θ';
  draw('text', { x: -5.5, y: -2.1, 'font-size': 0.36, 'font-style': 'italic' }, plane).textContent = 'φ';
  const flat = draw('path', { fill: 'none', stroke: LOCUS, 'stroke-width': 0.045, 'stroke-linejoin': 'round' }, plane);
  draw('circle', { cx: 0, cy: 0, r: 0.06 }, plane);

  const sphere = document.getElementById('slider-sphere');
  sphere.setAttribute('viewBox', '-1.15 -1.15 2.3 2.3');
  draw('circle', { cx: 0, cy: 0, r: 1, fill: 'none', stroke: GREY, 'stroke-width': 0.006 }, sphere);
  const back = draw('path', { fill: 'none', stroke: LOCUS, 'stroke-width': 0.006, opacity: 0.6 }, sphere);
  const rim = draw('path', { fill: 'none', stroke: EQUATOR, 'stroke-width': 0.006 }, sphere);
  const front = draw('path', { fill: 'none', stroke: LOCUS, 'stroke-width': 0.014, 'stroke-linejoin': 'round' }, sphere);
  let [turn, tilt] = [2.7, 0.45];
  const seen = ([a, b, c]) => {
    const [x, z] = [Math.cos(turn) * c - Math.sin(turn) * a, Math.cos(turn) * a + Math.sin(turn) * c];
    return [x, -(Math.cos(tilt) * b - Math.sin(tilt) * z), Math.cos(tilt) * z + Math.sin(tilt) * b];
  };
  const path = (points) => points.map(([x, y], i) => `${i ? 'L' : 'M'}${x.toFixed(4)} ${y.toFixed(4)}`).join('');
  const halves = (points) => {
    const parts = { front: '', back: '' };
    let run = [];
    const flush = (is_front) => { if (run.length > 1) parts[is_front ? 'front' : 'back'] += path(run); };
    points.map(seen).forEach((point, i, all) => {
      const is_front = point[2] >= 0;
      if (i && is_front !== all[i - 1][2] >= 0) { run.push(point); flush(!is_front); run = [all[i - 1]]; }
      run.push(point);
      if (i === all.length - 1) flush(is_front);
    });
    return parts;
  };
  const show = () => {
    const locus = data.loci[Number(input.value)];
    const branch = [];
    for (let i = 0; i < locus.length; i += 4) branch.push(locus.slice(i, i + 4).map((x) => x / UNIT));
    const signs = [[1, 1], [1, -1], [-1, 1], [-1, -1]];
    const phi = (r) => Math.acos(Math.min(1, Math.max(-1, r))) - Math.PI / 2;
    flat.setAttribute('d', signs.map(([s, e]) => path(branch.map(([theta, , up]) => [s * theta, e * phi(up)]))).join(''));
    const parts = signs.map(([s, e]) => halves(branch.map(([, a, b, c]) => [a, e * b, s * c])));
    front.setAttribute('d', parts.map((part) => part.front).join(''));
    back.setAttribute('d', parts.map((part) => part.back).join(''));
    const circle = halves(Array.from({ length: 145 }, (_, i) => [Math.cos(i * Math.PI / 72), 0, Math.sin(i * Math.PI / 72)]));
    rim.setAttribute('d', circle.front);
    output.value = data.k[Number(input.value)].toFixed(3);
    input.setAttribute('aria-valuetext', `k = ${output.value}`);
  };
  input.addEventListener('input', show);
  let timer = null;
  const stop = () => { clearInterval(timer); timer = null; play.textContent = 'Play'; };
  play.addEventListener('click', () => {
    if (timer) { stop(); return; }
    if (Number(input.value) === data.k.length - 1) input.value = 0;
    play.textContent = 'Pause';
    timer = setInterval(() => {
      if (Number(input.value) === data.k.length - 1) { stop(); return; }
      input.value = Number(input.value) + 1;
      show();
    }, 120);
  });
  let held = null;
  sphere.addEventListener('pointerdown', (event) => { held = [event.clientX, event.clientY]; sphere.setPointerCapture(event.pointerId); });
  sphere.addEventListener('pointermove', (event) => {
    if (!held) return;
    turn += (event.clientX - held[0]) / 120;
    tilt = Math.min(1.5, Math.max(-1.5, tilt + (event.clientY - held[1]) / 120));
    held = [event.clientX, event.clientY];
    show();
  });
  sphere.addEventListener('pointerup', () => { held = null; });
  show();
})();
