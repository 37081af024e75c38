// Elements, arrows and dragging for the pictures of "A step taken apart" and of the exercises.
const SVG = 'http://www.w3.org/2000/svg';

function filled(element, attributes, children) {
  for (const [name, value] of Object.entries(attributes)) {
    if (name.startsWith('on')) element.addEventListener(name.slice(2), value);
    else if (value === true) element.setAttribute(name, '');
    else if (value !== false && value !== null && value !== undefined) element.setAttribute(name, value);
  }
  element.append(...children.filter(child => child !== null && child !== undefined));
  return element;
}

/** An element of HTML: `on…` attributes are listeners. */
export const make = (name, attributes = {}, ...children) => filled(document.createElement(name), attributes, children);

/** An element of SVG. */
export const draw = (name, attributes = {}, ...children) => filled(document.createElementNS(SVG, name), attributes, children);

/** A picture of so many units; 1 unit is 1 pixel where the panel is 380 wide. */
export const picture = (width, height, label) => draw('svg', {viewBox: `0 0 ${width} ${height}`, role: 'img', 'aria-label': label, class: 'apart-picture'});

export const line = (a, b, cls) => draw('line', {x1: a[0], y1: a[1], x2: b[0], y2: b[1], class: cls});
export const disc = (at, r, cls) => draw('circle', {cx: at[0], cy: at[1], r, class: cls});
export const text = (at, words, cls = '', anchor = 'middle') => draw('text', {x: at[0], y: at[1], class: cls, 'text-anchor': anchor}, words);

/** An arrow; nothing where it would be shorter than a pixel. */
export function arrow(from, to, cls) {
  const d = [to[0] - from[0], to[1] - from[1]], size = Math.hypot(...d);
  if (size < 1) return draw('g');
  const head = Math.min(7, 0.6 * size), u = d.map(x => x / size), back = [to[0] - head * u[0], to[1] - head * u[1]], side = 0.45 * head;
  return draw('g', {class: cls}, line(from, back, 'shaft'),
    draw('polygon', {class: 'head', points: [to, [back[0] - side * u[1], back[1] + side * u[0]], [back[0] + side * u[1], back[1] - side * u[0]]].map(p => p.join()).join(' ')}));
}

/** Place of a pointer in units of a picture. */
export function place_in(svg, event) {
  const at = new DOMPoint(event.clientX, event.clientY).matrixTransform(svg.getScreenCTM().inverse());
  return [at.x, at.y];
}

/** Dragging of what `grabbed(place)` returns; `moved(thing, place)` as long as the pointer is down. */
export function drag(svg, grabbed, moved) {
  let thing = null;
  svg.addEventListener('pointerdown', event => {
    thing = grabbed(place_in(svg, event)) ?? null;
    if (thing === null) return;
    svg.setPointerCapture(event.pointerId);
    event.preventDefault();
  });
  svg.addEventListener('pointermove', event => { if (thing !== null) moved(thing, place_in(svg, event)); });
  for (const end of ['pointerup', 'pointercancel']) svg.addEventListener(end, () => { thing = null; });
  svg.addEventListener('touchmove', event => { if (thing !== null) event.preventDefault(); }, {passive: false});
}

export const button = (label, press, attributes = {}) => make('button', {type: 'button', onclick: press, ...attributes}, label);

/** A slider with its name and its value in words. @returns {{box, set(value), value}} */
export function slider(name, {min, max, step = 1, value, words = String, input}) {
  const range = make('input', {type: 'range', min, max, step, value}), output = make('output'), label = make('label', {class: 'apart-slider'}, make('span', {}, name, ' ', output), range);
  const show = () => { output.textContent = words(Number(range.value)); range.setAttribute('aria-valuetext', output.textContent); };
  range.addEventListener('input', () => { show(); input(Number(range.value)); });
  show();
  return {box: label, range, set(next) { range.value = next; show(); }, get value() { return Number(range.value); }};
}

/** One of several, as buttons that stay down. @returns {{box, set(name)}} */
export function choice(label, options, chosen) {
  const buttons = options.map(([name, words]) => button(words, () => { set(name); chosen(name); }, {'data-name': name, 'aria-pressed': 'false'}));
  const set = name => buttons.forEach(one => one.setAttribute('aria-pressed', String(one.dataset.name === name)));
  set(options[0][0]);
  return {box: make('div', {class: 'apart-choice', role: 'group', 'aria-label': label}, ...buttons), set};
}

/** A table with a head; rows are arrays of texts or elements, the first cell names the row. */
export function table(head, rows, label) {
  const cells = (list, name) => list.map((cell, at) => make(at ? name : 'th', at || name === 'th' ? {scope: name === 'th' ? 'col' : null} : {scope: 'row'}, cell));
  return make('table', {class: 'apart-table', 'aria-label': label}, make('thead', {}, make('tr', {}, ...cells(head, 'th'))), make('tbody', {}, ...rows.map(row => make('tr', {}, ...cells(row, 'td')))));
}

const minus_sign = words => words.replace('-', '−');
export const fixed = (x, digits = 3) => minus_sign((Math.abs(x) < 0.5 * 10 ** -digits ? 0 : x).toFixed(digits));

/** Three digits; small and large numbers as 1.2·10⁻⁷. */
export function short(x, digits = 2) {
  if (x === 0) return '0';
  if (!Number.isFinite(x)) return '–';
  if (Math.abs(x) >= 1e-3 && Math.abs(x) < 1e5) return minus_sign(String(Number(x.toPrecision(digits + 1))));
  const [mantissa, exponent] = x.toExponential(digits - 1).split('e');
  return `${minus_sign(mantissa)}·10${[...String(Number(exponent))].map(c => c === '-' ? '⁻' : '⁰¹²³⁴⁵⁶⁷⁸⁹'[c]).join('')}`;
}

/** 0.0123(4): a value and its error in the last digits, or value ± error where that is no shorter. */
export function with_error(value, error) {
  if (!(error > 0) || !Number.isFinite(error)) return short(value);
  const digits = Math.max(0, Math.min(8, 1 - Math.floor(Math.log10(error))));
  if (error < 1e-7) return `${short(value)} ± ${short(error, 1)}`;
  return `${minus_sign(value.toFixed(digits))} ± ${error.toFixed(digits)}`;
}

/** Equations, a line each, with their numbers in the paper. */
export const equation = (...lines) => make('p', {class: 'apart-equation'}, ...lines.flatMap((line, at) => at ? [make('br'), line] : [line]));

/** Styles of the two panels, put into the page once. */
export function dress() {
  if (!document.querySelector('link[href="apart.css"]')) document.head.append(make('link', {rel: 'stylesheet', href: 'apart.css'}));
}
