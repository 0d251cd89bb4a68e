// SPDX-License-Identifier: Apache-2.0
// The report's script: pictures are halves that are developed here, so that exposure is that of the scene's light.
'use strict';
(function () {
const $ = id => document.getElementById(id);
const data = JSON.parse($('data').textContent);
const THUMB = 300; // pixels of a cell's picture in the grid, at most
const state = { stops: 0, a: 0, b: 0, mode: 'swipe', border: 0.5, shown: 0, gain: 1, sort: null, down: false };
const pictures = []; // { width, height, halves, thumb, developed }
let lut = null, coordinate = null, flipTimer = 0;

function element(name, properties, ...children) {
  const made = Object.assign(document.createElement(name), properties);
  made.append(...children);
  return made;
}

// --- numbers ---

const fromHalf = new Float32Array(65536);
for (let i = 0; i < 65536; i++) {
  const exponent = i >> 10 & 31, mantissa = i & 1023;
  const value = exponent ? (1 + mantissa / 1024) * 2 ** (exponent - 15) : mantissa * 2 ** -24;
  fromHalf[i] = i & 0x8000 ? -value : value;
}
function toHalf(value) {
  const magnitude = Math.min(Math.abs(value), 65504), sign = value < 0 ? 0x8000 : 0;
  if (magnitude < 2 ** -14) return sign | Math.round(magnitude * 2 ** 24);
  const exponent = Math.floor(Math.log2(magnitude));
  return sign | (exponent + 15 << 10) + Math.round((magnitude / 2 ** exponent - 1) * 1024);
}
const encodeSrgb = v => v <= 0.0031308 ? 12.92 * v : 1.055 * v ** (1 / 2.4) - 0.055;
function show(value, digits) {
  if (value === null || value === undefined || Number.isNaN(value)) return '–';
  if (!Number.isFinite(value)) return value > 0 ? '∞' : '-∞';
  const size = Math.abs(value);
  return size !== 0 && (size < 1e-3 || size >= 1e5) ? value.toExponential(2) : value.toPrecision(digits || 4);
}

// --- pictures out of the page ---

async function unpack(id, count) {
  const text = atob($(id).textContent.trim()), packed = new Uint8Array(text.length);
  for (let i = 0; i < text.length; i++) packed[i] = text.charCodeAt(i);
  const stream = new Blob([packed]).stream().pipeThrough(new DecompressionStream('deflate'));
  const bytes = new Uint8Array(await new Response(stream).arrayBuffer());
  if (bytes.length !== 6 * count) throw new Error('the data of ' + id + ' are damaged');
  for (let i = 1; i < bytes.length; i++) bytes[i] += bytes[i - 1];
  const halves = new Uint16Array(3 * count);
  for (let c = 0; c < 3; c++)
    for (let i = 0, high = 2 * count * c; i < count; i++) halves[3 * i + c] = bytes[high + i] << 8 | bytes[high + count + i];
  return halves;
}

// Means over squares, as halves again.
function shrink(picture) {
  const f = Math.max(1, Math.floor(picture.width / THUMB)), width = Math.floor(picture.width / f);
  const height = Math.max(1, Math.floor(picture.height / f));
  if (f === 1) return picture;
  const halves = new Uint16Array(3 * width * height);
  for (let y = 0; y < height; y++)
    for (let x = 0; x < width; x++)
      for (let c = 0; c < 3; c++) {
        let sum = 0;
        for (let v = 0; v < f; v++)
          for (let u = 0; u < f; u++) sum += fromHalf[picture.halves[3 * ((y * f + v) * picture.width + x * f + u) + c]];
        halves[3 * (y * width + x) + c] = toHalf(sum / (f * f));
      }
  return { width, height, halves, kind: picture.kind };
}

// --- development ---

// The view as a table over log2 of light, between its points as tetrahedra.
async function loadView() {
  if (!data.view) return;
  const n = data.view.size, halves = await unpack('view', n * n * n), scale = (n - 1) / (data.view.high - data.view.low);
  lut = new Float32Array(halves.length);
  for (let i = 0; i < halves.length; i++) lut[i] = 255 * fromHalf[halves[i]];
  coordinate = new Float32Array(65536);
  for (let i = 0; i < 65536; i++)
    coordinate[i] = fromHalf[i] > 0 ? (Math.log2(fromHalf[i]) - data.view.low) * scale : -1e6;
}
function developView(halves, stops, out) {
  const n = data.view.size, most = n - 1, gd = 3 * n, bd = 3 * n * n;
  const shift = stops * most / (data.view.high - data.view.low);
  for (let i = 0, j = 0; i < halves.length; i += 3, j += 4) {
    let r = coordinate[halves[i]] + shift, g = coordinate[halves[i + 1]] + shift, b = coordinate[halves[i + 2]] + shift;
    r = r < 0 ? 0 : r > most ? most : r;
    g = g < 0 ? 0 : g > most ? most : g;
    b = b < 0 ? 0 : b > most ? most : b;
    let ri = r | 0, gi = g | 0, bi = b | 0;
    if (ri === most) ri--;
    if (gi === most) gi--;
    if (bi === most) bi--;
    r -= ri; g -= gi; b -= bi;
    const p = 3 * ri + gd * gi + bd * bi;
    let first, second, high, middle, low;
    if (r >= g) {
      if (g >= b) { first = 3; second = 3 + gd; high = r; middle = g; low = b; }
      else if (r >= b) { first = 3; second = 3 + bd; high = r; middle = b; low = g; }
      else { first = bd; second = 3 + bd; high = b; middle = r; low = g; }
    } else if (b >= g) { first = bd; second = gd + bd; high = b; middle = g; low = r; }
    else if (b >= r) { first = gd; second = gd + bd; high = g; middle = b; low = r; }
    else { first = gd; second = gd + 3; high = g; middle = r; low = b; }
    const w0 = 1 - high, w1 = high - middle, w2 = middle - low, q1 = p + first, q2 = p + second, q3 = p + 3 + gd + bd;
    out[j] = w0 * lut[p] + w1 * lut[q1] + w2 * lut[q2] + low * lut[q3];
    out[j + 1] = w0 * lut[p + 1] + w1 * lut[q1 + 1] + w2 * lut[q2 + 1] + low * lut[q3 + 1];
    out[j + 2] = w0 * lut[p + 2] + w1 * lut[q1 + 2] + w2 * lut[q2 + 2] + low * lut[q3 + 2];
    out[j + 3] = 255;
  }
}
// Display values were made linear for the page; they are encoded again.
const curves = new Map();
function curve(stops) {
  if (!curves.has(stops)) {
    const table = new Uint8ClampedArray(65536), gain = 2 ** stops;
    for (let i = 0; i < 65536; i++) table[i] = 255 * encodeSrgb(Math.min(1, Math.max(0, fromHalf[i] * gain)));
    if (curves.size > 8) curves.clear();
    curves.set(stops, table);
  }
  return curves.get(stops);
}
function developCurve(halves, stops, out) {
  const table = curve(stops);
  for (let i = 0, j = 0; i < halves.length; i += 3, j += 4) {
    out[j] = table[halves[i]];
    out[j + 1] = table[halves[i + 1]];
    out[j + 2] = table[halves[i + 2]];
    out[j + 3] = 255;
  }
}
function develop(picture) {
  const stops = picture.kind === 'fixed' ? 0 : state.stops;
  if (picture.developed && picture.developedStops === stops) return picture.developed;
  const image = picture.developed || new ImageData(picture.width, picture.height);
  (picture.kind === 'view' ? developView : developCurve)(picture.halves, stops, image.data);
  picture.developed = image;
  picture.developedStops = stops;
  return image;
}
// |A - B| of light, times exposure and gain, as sRGB.
function developDifference(a, b) {
  const image = new ImageData(a.width, a.height), out = image.data, scale = 2 ** state.stops * state.gain;
  for (let i = 0, j = 0; i < a.halves.length; i += 3, j += 4) {
    for (let c = 0; c < 3; c++)
      out[j + c] = 255 * encodeSrgb(Math.min(1, Math.abs(fromHalf[a.halves[i + c]] - fromHalf[b.halves[i + c]]) * scale));
    out[j + 3] = 255;
  }
  return image;
}

// --- cells ---

const cells = data.cells, canvases = [];
const pictureOf = cell => cells[cell].picture === null ? null : pictures[cells[cell].picture];
const shownCells = cells.map((cell, i) => i).filter(i => cells[i].picture !== null);

function makeCell(index) {
  const cell = cells[index], picture = cell.picture === null ? null : data.pictures[cell.picture];
  const button = element('button', { type: 'button', className: 'cell', id: 'cell-' + index, tabIndex: -1 });
  const width = picture ? Math.min(THUMB, Math.max(picture.width, 160)) : 220;
  button.style.setProperty('--natural', width + 'px');
  button.setAttribute('aria-label', cell.label + (cell.fault ? ', failed' : ''));
  if (picture) {
    const canvas = element('canvas', {});
    canvas.style.aspectRatio = picture.width + ' / ' + picture.height;
    canvases[index] = canvas;
    button.append(canvas, element('span', { className: 'mark', id: 'mark-' + index }));
    button.onclick = event => choose(event.shiftKey ? 'a' : 'b', index);
  } else {
    const missing = element('span', { className: 'missing', textContent: cell.fault || 'not rendered' });
    missing.style.minHeight = '120px';
    button.append(missing);
    button.setAttribute('aria-disabled', 'true');
  }
  if (!data.layout.grid) button.append(element('span', { className: 'caption', textContent: cell.label }));
  return button;
}
function makeGrid() {
  const { rows, columns, grid } = data.layout, table = $('grid');
  table.style.setProperty('--columns', columns);
  if (grid) {
    const titled = rows > 1 || data.layout.rowTitle;
    const head = element('tr', {}), top = element('tr', {});
    if (titled) {
      top.append(element('td', {}));
      head.append(element('th', { className: 'axis', scope: 'col', textContent: data.layout.rowTitle }));
    }
    top.append(element('th', { className: 'axis', colSpan: columns, textContent: data.layout.columnTitle }));
    for (const label of data.layout.columnLabels) head.append(element('th', { scope: 'col', textContent: label }));
    if (data.layout.columnTitle) table.append(top);
    table.append(head);
  }
  for (let r = 0; r < rows; r++) {
    const row = element('tr', {});
    if (grid && (rows > 1 || data.layout.rowTitle))
      row.append(element('th', { scope: 'row', textContent: data.layout.rowLabels[r] }));
    for (let c = 0; c < columns && r * columns + c < cells.length; c++)
      row.append(element('td', {}, makeCell(r * columns + c)));
    table.append(row);
  }
  const first = $('cell-' + (shownCells[0] || 0));
  if (first) first.tabIndex = 0;
  table.addEventListener('keydown', moveInGrid);
}
function moveInGrid(event) {
  const at = Number((event.target.id || '').slice(5)), columns = data.layout.columns;
  const step = { ArrowLeft: -1, ArrowRight: 1, ArrowUp: -columns, ArrowDown: columns }[event.key];
  if (event.key === 'r' && pictureOf(at)) { choose('a', at); return; }
  if (event.key === 'Home' || event.key === 'End' || step) {
    const to = event.key === 'Home' ? 0 : event.key === 'End' ? cells.length - 1 : at + step;
    if ($('cell-' + to)) {
      $('cell-' + at).tabIndex = -1;
      $('cell-' + to).tabIndex = 0;
      $('cell-' + to).focus();
    }
    event.preventDefault();
  }
}
function markCells() {
  cells.forEach((cell, i) => {
    const mark = $('mark-' + i);
    if (!mark) return;
    mark.replaceChildren(...[['a', 'A'], ['b', 'B']].filter(x => state[x[0]] === i)
      .map(x => element('b', { textContent: x[1] })));
    $('cell-' + i).classList.toggle('is-a', state.a === i);
    $('cell-' + i).classList.toggle('is-b', state.b === i);
  });
}
// A few at a time: a hundred cells must not hold the slider.
let thumbTurn = 0;
function paintThumbs() {
  const turn = ++thumbTurn, waiting = shownCells.slice();
  function some() {
    if (turn !== thumbTurn) return;
    const end = performance.now() + 12;
    while (waiting.length && performance.now() < end) {
      const index = waiting.shift(), thumb = pictureOf(index).thumb, canvas = canvases[index];
      if (canvas.width !== thumb.width) canvas.width = thumb.width;
      if (canvas.height !== thumb.height) canvas.height = thumb.height;
      canvas.getContext('2d', { willReadFrequently: true }).putImageData(develop(thumb), 0, 0);
    }
    if (waiting.length) requestAnimationFrame(some);
    else document.body.dataset.painted = String(state.stops);
  }
  some();
}

// --- A against B ---

const modes = { swipe: 'Swipe', flip: 'Flip', difference: 'Difference' };
function makeModes() {
  Object.keys(modes).forEach(mode => {
    const button = element('button', { type: 'button', id: 'mode-' + mode, textContent: modes[mode] });
    button.setAttribute('role', 'radio');
    button.onclick = () => setMode(mode);
    button.onkeydown = event => {
      const names = Object.keys(modes), step = { ArrowRight: 1, ArrowLeft: -1 }[event.key];
      if (!step) return;
      const next = names[(names.indexOf(mode) + step + names.length) % names.length];
      setMode(next);
      $('mode-' + next).focus();
      event.preventDefault();
    };
    $('modes').append(button);
  });
}
function setMode(mode) {
  state.mode = mode;
  Object.keys(modes).forEach(name => {
    $('mode-' + name).setAttribute('aria-checked', String(name === mode));
    $('mode-' + name).tabIndex = name === mode ? 0 : -1;
  });
  document.querySelectorAll('.only').forEach(e => { e.hidden = e.dataset.mode !== mode; });
  $('stage').className = mode;
  if (mode !== 'flip') setAuto(false);
  paintStage();
}
function setAuto(on) {
  clearInterval(flipTimer);
  $('auto').checked = on;
  if (on) flipTimer = setInterval(flip, 500);
}
function flip() {
  state.shown = 1 - state.shown;
  $('flip').setAttribute('aria-pressed', String(state.shown === 1));
  paintStage();
}
const comparable = () => {
  const a = pictureOf(state.a), b = pictureOf(state.b);
  return a && b && a.width === b.width && a.height === b.height;
};
function paintStage() {
  const a = pictureOf(state.a), b = pictureOf(state.b), canvas = $('canvas');
  if (!a || !b) return;
  const single = !comparable() ? (state.mode === 'flip' && state.shown === 0 ? a : b) : null;
  const size = single || a;
  if (canvas.width !== size.width || canvas.height !== size.height) {
    canvas.width = size.width;
    canvas.height = size.height;
    setZoom();
  }
  const context = canvas.getContext('2d', { willReadFrequently: true }), x = Math.round(state.border * size.width);
  if (single) context.putImageData(develop(single), 0, 0);
  else if (state.mode === 'flip') context.putImageData(develop(state.shown ? b : a), 0, 0);
  else if (state.mode === 'difference') context.putImageData(developDifference(a, b), 0, 0);
  else {
    context.putImageData(develop(a), 0, 0, 0, 0, x, size.height);
    context.putImageData(develop(b), 0, 0, x, 0, size.width - x, size.height);
  }
  const swipes = state.mode === 'swipe' && !single;
  $('divider').hidden = !swipes;
  $('divider').style.left = 100 * x / size.width + '%';
  $('tag-a').textContent = 'A  ' + cells[state.a].label;
  $('tag-b').textContent = 'B  ' + cells[state.b].label;
  $('tag-a').hidden = state.mode === 'difference' || (state.mode === 'flip' && state.shown === 1) || single === b;
  $('tag-b').hidden = state.mode === 'difference' || (state.mode === 'flip' && state.shown === 0);
  if (single) $('readout').textContent = 'A and B differ in size: only one of them is shown.';
}
function setZoom() {
  const zoom = Number($('zoom').value), canvas = $('canvas'), natural = canvas.width * shownFactor();
  canvas.style.width = zoom ? canvas.width * zoom / devicePixelRatio + 'px' : Math.max(natural, 640) + 'px';
  canvas.style.maxWidth = zoom ? 'none' : '100%';
  $('stage').style.maxWidth = zoom ? 'none' : '100%';
  canvas.classList.toggle('crisp', zoom > 1);
}
const shownFactor = () => data.pictures[cells[state.a].picture].factor;
function setBorder(value) {
  state.border = Math.min(1, Math.max(0, value));
  $('swipe').value = state.border;
  paintStage();
}
function choose(side, index) {
  if (cells[index].picture === null) return;
  state[side] = index;
  $(side).value = String(index);
  markCells();
  paintStage();
  showCommands();
  if (side === 'a' && data.kind === 'sweep' && $('reference').value !== String(index)) {
    $('reference').value = String(index);
  }
  makeTable();
}
function readPixel(event) {
  const canvas = $('canvas'), box = canvas.getBoundingClientRect(), a = pictureOf(state.a), b = pictureOf(state.b);
  const x = Math.floor((event.clientX - box.left) / box.width * canvas.width);
  const y = Math.floor((event.clientY - box.top) / box.height * canvas.height);
  if (!comparable() || x < 0 || y < 0 || x >= canvas.width || y >= canvas.height) return;
  const at = 3 * (y * canvas.width + x), f = shownFactor(), corner = data.pictures[cells[state.a].picture].corner;
  const read = p => [0, 1, 2].map(c => fromHalf[p.halves[at + c]]);
  const va = read(a), vb = read(b), line = v => v.map(n => n.toFixed(3).padStart(8)).join('');
  $('readout').textContent = `${corner[0] + x * f},${corner[1] + y * f}  A${line(va)}  B${line(vb)}\nB-A` +
    line(vb.map((n, i) => n - va[i]));
}

// --- commands ---

async function copy(text, button) {
  let good = false;
  try {
    await navigator.clipboard.writeText(text);
    good = true;
  } catch (error) { // no permission for pages from files in some browsers
    const area = element('textarea', { value: text });
    document.body.append(area);
    area.select();
    good = document.execCommand('copy');
    area.remove();
  }
  const before = button.dataset.text || button.textContent;
  button.dataset.text = before;
  button.textContent = good ? 'Copied' : 'Not copied';
  document.body.dataset.copied = good ? text : '';
  setTimeout(() => { button.textContent = before; }, 1500);
}
function showCommands() {
  const list = $('commands');
  list.replaceChildren();
  for (const side of ['a', 'b']) {
    const cell = cells[state[side]];
    if (!cell.command || (side === 'b' && state.a === state.b)) continue;
    const button = element('button', { type: 'button', textContent: 'Copy', id: 'copy-' + side });
    button.setAttribute('aria-label', 'Copy the command of ' + cell.label);
    button.onclick = () => copy(cell.command, button);
    list.append(element('dt', { textContent: `${side.toUpperCase()}: the same bytes again, from the folder where the sweep ran` }),
      element('dd', {}, element('code', { textContent: cell.command }), button));
  }
}

// --- measures ---

const known = new Map(data.pairs.map(pair => [pair.reference + '/' + pair.test, pair]));
// From the pictures of the page, where the program has not measured.
function measure(reference, test) {
  const r = pictureOf(reference), t = pictureOf(test);
  if (!r || !t || r.width !== t.width || r.height !== t.height || r.kind !== t.kind) return null;
  let square = 0, relative = 0, absolute = 0, peak = 0;
  const n = r.halves.length;
  for (let i = 0; i < n; i++) {
    const x = fromHalf[r.halves[i]], d = fromHalf[t.halves[i]] - x;
    square += d * d;
    relative += d * d / (x * x + 0.01);
    absolute += Math.abs(d);
    peak = Math.max(peak, Math.abs(x));
  }
  const rmse = Math.sqrt(square / n);
  return { rmse, relmse: relative / n, mae: absolute / n, psnr: rmse > 0 ? 20 * Math.log10(peak / rmse) : Infinity };
}
const measured = new Map();
function valuesOf(reference, test) {
  const key = reference + '/' + test;
  if (known.has(key)) return { values: known.get(key).values, exact: true, broken: known.get(key).broken || [] };
  if (!measured.has(key)) measured.set(key, measure(reference, test));
  return { values: measured.get(key) || {}, exact: false, broken: [] };
}
function rowsOf() {
  if (data.kind !== 'sweep') return data.pairs.map(pair => ({ reference: pair.reference, test: pair.test }));
  const reference = Number($('reference').value);
  return cells.map((cell, i) => ({ reference, test: i }));
}
function makeTable() {
  if (!data.pairs.length && data.kind !== 'sweep') { $('measures').hidden = true; return; }
  const columns = data.axes.map((name, i) => ({ name, text: row => cells[row.test].values[i] }));
  for (const name of data.metrics)
    columns.push({ name: data.metricNames[name], value: row => row.same ? null : row.found.values[name], metric: name });
  const timed = cells.some(cell => typeof cell.seconds === 'number');
  if (timed) columns.push({ name: 'time, s', value: row => cells[row.test].seconds });
  const rows = rowsOf().map(row => ({ ...row, same: row.reference === row.test, found: valuesOf(row.reference, row.test) }));
  if (state.sort !== null) {
    const column = columns[state.sort], sign = state.down ? -1 : 1, empty = v => v === null || v === undefined;
    rows.sort((p, q) => {
      if (column.text) {
        const x = column.text(p), y = column.text(q), both = !Number.isNaN(Number(x)) && !Number.isNaN(Number(y));
        return sign * (both ? Number(x) - Number(y) : x < y ? -1 : x > y ? 1 : 0);
      }
      const x = column.value(p), y = column.value(q);
      return empty(x) || empty(y) ? empty(x) - empty(y) : sign * (x - y || 0);
    });
  }
  $('table').replaceChildren(makeHead(columns), makeBody(columns, rows));
  const exact = rows.every(row => row.found.exact || row.same);
  $('table-hint').textContent = data.metricHint + (exact ? '' : ' ≈: computed here, from the pictures of this page.');
}
function makeHead(columns) {
  const head = element('tr', {});
  columns.forEach((column, i) => {
    const cell = element('th', { scope: 'col', className: column.text ? 'text' : '' });
    const button = element('button', { type: 'button', textContent: column.name });
    button.onclick = () => {
      state.down = state.sort === i ? !state.down : false;
      state.sort = i;
      makeTable();
      $('table').querySelectorAll('thead button')[i].focus();
    };
    if (state.sort === i) cell.setAttribute('aria-sort', state.down ? 'descending' : 'ascending');
    cell.append(button);
    head.append(cell);
  });
  if (cells.some(cell => cell.command)) head.append(element('th', { scope: 'col', className: 'text' }));
  return element('thead', {}, head);
}
function makeBody(columns, rows) {
  const body = element('tbody', {});
  for (const row of rows) {
    const line = element('tr', { className: row.test === state.b ? 'is-b' : '' }), cell = cells[row.test];
    line.dataset.cell = String(row.test);
    for (const column of columns) {
      if (column.text) { line.append(element('td', { className: 'text', textContent: column.text(row) })); continue; }
      const value = column.value(row), bad = column.metric && row.found.broken.includes(column.metric);
      const guess = column.metric && !row.found.exact && !row.same && typeof value === 'number' ? '≈ ' : '';
      const infinite = column.metric === 'psnr' && row.found.values.rmse === 0 && !row.same;
      const text = row.same && column.metric ? (column.metric === data.metrics[0] ? 'reference' : '') :
        cell.picture === null && column.metric ? (column.metric === data.metrics[0] ? 'failed' : '') :
        guess + (infinite ? '∞' : show(value));
      line.append(element('td', { textContent: text, className: bad ? 'bad' : '' }));
    }
    if (cell.command) {
      const button = element('button', { type: 'button', textContent: 'Copy command' });
      button.setAttribute('aria-label', 'Copy the command of ' + cell.label);
      button.onclick = event => { event.stopPropagation(); copy(cell.command, button); };
      line.append(element('td', { className: 'text' }, button));
    }
    line.onclick = () => choose('b', row.test);
    body.append(line);
  }
  return body;
}

// --- the page ---

let waiting = false;
function setExposure(value) {
  state.stops = Math.round(10 * value) / 10;
  $('exposure').value = state.stops;
  $('stops').textContent = (state.stops > 0 ? '+' : '') + state.stops.toFixed(1) + ' stops';
  $('exposure').setAttribute('aria-valuetext', state.stops.toFixed(1) + ' stops');
  if (waiting) return;
  waiting = true;
  requestAnimationFrame(() => { waiting = false; paintStage(); paintThumbs(); });
}
function fillSelects() {
  for (const id of ['a', 'b', 'reference'])
    for (const i of shownCells) $(id).append(element('option', { value: String(i), textContent: cells[i].label }));
  $('a').onchange = () => choose('a', Number($('a').value));
  $('b').onchange = () => choose('b', Number($('b').value));
  $('reference').onchange = () => makeTable();
  $('reference-line').hidden = data.kind !== 'sweep';
}
function listen() {
  const stage = $('stage'), fraction = event => {
    const box = $('canvas').getBoundingClientRect();
    return (event.clientX - box.left) / box.width;
  };
  $('exposure').oninput = () => setExposure(Number($('exposure').value));
  $('reset').onclick = () => setExposure(0);
  $('swipe').oninput = () => setBorder(Number($('swipe').value));
  $('flip').onclick = flip;
  $('auto').onchange = () => setAuto($('auto').checked);
  $('gain').oninput = () => {
    state.gain = 2 ** Number($('gain').value);
    $('gain-text').textContent = '×' + (state.gain < 10 ? Number(state.gain.toFixed(1)) : Math.round(state.gain));
    paintStage();
  };
  $('zoom').onchange = setZoom;
  $('swap').onclick = () => { const { a, b } = state; choose('a', b); choose('b', a); };
  stage.onpointerdown = event => {
    if (state.mode === 'flip') flip();
    if (state.mode !== 'swipe') return;
    stage.setPointerCapture(event.pointerId);
    setBorder(fraction(event));
    event.preventDefault();
    $('stage-frame').focus({ preventScroll: true });
  };
  stage.onpointermove = event => {
    readPixel(event);
    if (state.mode === 'swipe' && event.buttons & 1) setBorder(fraction(event));
  };
  $('stage-frame').onkeydown = event => {
    const step = { ArrowLeft: -0.01, ArrowRight: 0.01 }[event.key];
    if (step && state.mode === 'swipe') setBorder(state.border + step);
    else if (event.key === ' ' && state.mode === 'flip') flip();
    else if (event.key === 'x') $('swap').click();
    else return;
    event.preventDefault();
  };
}
async function start() {
  $('facts').textContent = data.facts;
  $('footer').textContent = data.footer;
  $('grid-hint').textContent = data.hint;
  if (data.verdict) $('facts').append(' ', element('strong', { className: data.failed ? 'bad' : 'good', textContent: data.verdict }));
  if (data.fault) { $('fault').textContent = data.fault; $('fault').hidden = false; }
  makeGrid();
  fillSelects();
  makeModes();
  listen();
  if (!shownCells.length) {
    document.querySelectorAll('#compare, #bar').forEach(e => { e.hidden = true; });
    $('measures').hidden = true;
    if (!cells.length) $('grid').closest('section').hidden = true;
    document.body.dataset.ready = 'yes';
    return;
  }
  $('busy').textContent = 'unpacking the pictures …';
  await loadView();
  for (let i = 0; i < data.pictures.length; i++) {
    const { width, height, kind } = data.pictures[i];
    const picture = { width, height, kind, halves: await unpack('picture-' + i, width * height) };
    picture.thumb = shrink(picture);
    pictures.push(picture);
    $('picture-' + i).remove(); // a hundred megabytes of text are no longer needed
  }
  $('busy').textContent = '';
  const first = shownCells.includes(data.first[0]) ? data.first[0] : shownCells[0];
  state.a = first;
  state.b = shownCells.includes(data.first[1]) ? data.first[1] : shownCells.find(i => i !== first) ?? first;
  $('reference').value = String(first);
  $('a').value = String(state.a);
  choose('b', state.b);
  setMode('swipe');
  setExposure(0);
  document.body.dataset.ready = 'yes';
}
start().catch(error => {
  $('fault').textContent = 'This report cannot be shown here: ' + error.message + (typeof DecompressionStream === 'undefined' ?
    '. It needs a browser of 2023 or later.' : '');
  $('fault').hidden = false;
});
}());
