// The plots, by uPlot: rows of measures.js, each beside the same of the last run, in grey.
import uPlot from './packages/uplot/uPlot.esm.js';
import {measures} from './measures.js';
import {paint, kinds, theme} from './palette.js';

const points_at_most = 700;

/** Every n-th point, so that at most 700 are left; the last one always. */
function thin({x, y, error}) {
  const every = Math.ceil(x.length / points_at_most), kept = at => at % every === 0 || at === x.length - 1;
  return every <= 1 ? {x, y, error} : {x: x.filter((_, at) => kept(at)), y: y.filter((_, at) => kept(at)), error: error?.filter((_, at) => kept(at))};
}

/** Columns on one axis of x, as uPlot wants them; missing points and, on a logarithmic axis, those below 0 are null. */
function align(series, log) {
  const fits = value => Number.isFinite(value) && (!log || value > 0);
  const all = series.map(one => ({...one, ...thin(one)}));
  const xs = [...new Set(all.flatMap(one => one.x))].filter(fits).sort((a, b) => a - b), place = new Map(xs.map((x, at) => [x, at]));
  const columns = all.map(one => {
    const column = {y: new Array(xs.length).fill(null), error: new Array(xs.length).fill(0)};
    one.x.forEach((x, at) => {
      if (!place.has(x) || !fits(one.y[at])) return;
      column.y[place.get(x)] = one.y[at];
      column.error[place.get(x)] = one.error?.[at] || 0;
    });
    return column;
  });
  return {data: [xs, ...columns.map(column => column.y)], errors: columns.map(column => column.error)};
}

/** Numbers at an axis, with as many digits as tell them apart. */
function ticks(chart, splits, axis, space, step) {
  const largest = Math.max(...splits.map(value => Math.abs(value ?? 0)));
  if (!(step > 0) || !(largest > 0)) return splits.map(value => value === null ? '' : Number(value.toPrecision(3)).toString());
  if (largest < 1e-3 || largest >= 1e6) return splits.map(value => value ? value.toExponential(Math.max(0, Math.ceil(Math.log10(largest / step)))).replace('e-', 'e−') : '0');
  let digits = 0;
  while (digits < 6 && Math.abs(step * 10 ** digits - Math.round(step * 10 ** digits)) > 1e-6 * 10 ** digits * step) digits++;
  return splits.map(value => value === null ? '' : value.toFixed(digits).replace('-', '−'));
}

/** The same of a logarithmic axis: decades only. */
const decades = (chart, splits) => splits.map(value => value === null ? '' : value >= 1e-3 && value < 1e4 ? String(Number(value.toPrecision(3))) : value.toExponential(0).replace('e-', 'e−').replace('e+', 'e'));

const look = role => ({
  main: {stroke: kinds[theme()][0], width: 2},
  second: {stroke: kinds[theme()][1], width: 2},
  faint: {stroke: paint('--line'), width: 1.5},
  ghost: {stroke: paint('--soft'), width: 1.5, dash: [2, 3]},
  theory: {stroke: paint('--ink'), width: 1.5, dash: [8, 5]},
})[role];

/** Draws an upright line from y - error to y + error at each point that has one. */
const bars = errors => ({hooks: {draw: chart => {
  const {ctx} = chart;
  const {left, top, width, height} = chart.bbox;
  ctx.save();
  ctx.beginPath();
  ctx.rect(left, top, width, height);
  ctx.clip();
  ctx.lineWidth = 1.5 * devicePixelRatio;
  ctx.setLineDash([]);
  errors.now?.forEach((column, at) => {
    ctx.strokeStyle = chart.series[at + 1].stroke(chart, at + 1);
    ctx.beginPath();
    column.forEach((error, row) => {
      const y = chart.data[at + 1][row];
      if (!error || y === null) return;
      const x = chart.valToPos(chart.data[0][row], 'x', true), low = chart.scales.y.distr === 3 ? Math.max(y - error, chart.scales.y.min) : y - error;
      ctx.moveTo(x, chart.valToPos(low, 'y', true));
      ctx.lineTo(x, chart.valToPos(y + error, 'y', true));
    });
    ctx.stroke();
  });
  ctx.restore();
}}});

export class Plots {
  #place; #cards = new Map(); #ghosts = new Map(); #pasts = new Map(); #button;

  /** button: {measure, label, press} of a plot that has one: shown if `label(values)` says a text. */
  constructor(place, button) {
    this.#place = place;
    this.#button = button;
    new ResizeObserver(() => this.#cards.forEach(card => this.#fit(card))).observe(place);
  }

  /** A new run begins. keep: what the last one showed stays in grey. */
  begin(keep) {
    for (const [id, card] of this.#cards) {
      if (keep && card.drawing) this.#ghosts.set(id, card.drawing.series.filter(one => one.role === 'main'));
      card.drawing = null;
    }
    if (!keep) {
      this.#ghosts.clear();
      this.#cards.forEach(card => { card.chart?.destroy(); card.box.remove(); });
      this.#cards.clear();
    }
    this.#pasts.clear();
    return this.#ghosts.size > 0;
  }

  /** Draws what the tables of a worker's message have. context: {values, check, info, kind, time}. */
  take(tables, context) {
    const named = new Map(tables.map(table => [table.name, table])), columns = new Map();
    const source = {...context, past: (name, key, row) => this.#past(`${name}/${key}`, row), table: name => {
      if (!named.has(name)) return null;
      if (!columns.has(name)) columns.set(name, by_column(named.get(name)));
      return columns.get(name);
    }};
    for (const measure of measures) {
      const drawing = measure.draw(source), card = this.#cards.get(measure.id);
      if (drawing) this.#draw(measure, card ?? this.#card(measure), drawing, context.values);
    }
  }

  #past(name, row) {
    if (!this.#pasts.has(name)) this.#pasts.set(name, row.map(() => []));
    const past = this.#pasts.get(name);
    if (past[0].at(-1) !== row[0]) row.forEach((value, at) => past[at].push(value));
    if (past[0].length > 60) past.forEach((column, at) => { past[at] = column.filter((_, place) => place % 2 === 1); });
    return past;
  }

  #card(measure) {
    const box = document.createElement('article'), card = {box, measure, errors: {}};
    box.className = 'plot';
    box.id = `plot-${measure.id}`;
    box.innerHTML = '<h3></h3><p class="see"></p><ul class="keys"></ul><div class="chart" role="img"></div><p class="now"></p>';
    box.querySelector('h3').textContent = measure.title;
    box.querySelector('.chart').setAttribute('aria-label', `Plot: ${measure.title}, ${measure.y} over ${measure.x}. The sentence below has its last value.`);
    const after = measures.slice(measures.indexOf(measure) + 1).map(one => this.#cards.get(one.id)?.box).find(Boolean);
    this.#place.insertBefore(box, after ?? null);
    if (this.#button.measure === measure.id) {
      card.button = Object.assign(document.createElement('button'), {type: 'button', onclick: this.#button.press});
      box.append(card.button);
    }
    this.#cards.set(measure.id, card);
    return card;
  }

  #draw(measure, card, drawing, values) {
    const ghosts = (this.#ghosts.get(measure.id) ?? []).map(one => ({...one, label: 'last run', role: 'ghost', error: undefined}));
    const series = [...ghosts, ...drawing.series], {data, errors} = align(series, measure.log), form = series.map(one => one.label + one.role).join('|');
    [card.drawing, card.values] = [drawing, values];
    card.errors.now = errors;
    card.box.querySelector('.now').textContent = drawing.now ?? '';
    card.box.querySelector('.see').textContent = typeof measure.see === 'function' ? measure.see(values) : measure.see;
    if (card.button) {
      card.button.textContent = this.#button.label(values) ?? '';
      card.button.hidden = !card.button.textContent;
    }
    if (card.chart && card.form === form) {
      card.chart.setData(data);
      return;
    }
    card.chart?.destroy();
    card.form = form;
    card.chart = new uPlot(this.#options(measure, card, series), data, card.box.querySelector('.chart'));
    this.#keys(card, series);
  }

  #options(measure, card, series) {
    const axis = label => ({label, stroke: paint('--soft'), labelSize: 18, labelFont: '12px system-ui', font: '12px system-ui', grid: {stroke: paint('--line'), width: 1}, ticks: {stroke: paint('--line'), width: 1, size: 4}, labelGap: 0});
    return {width: this.#width(card), height: 210, legend: {show: false}, cursor: {show: false}, plugins: [bars(card.errors)],
      scales: {x: {time: false, distr: measure.log ? 3 : 1}, y: {distr: measure.log ? 3 : 1}},
      axes: [{...axis(measure.x), size: 30, values: measure.log ? decades : ticks}, {...axis(measure.y), size: 58, values: measure.log ? decades : ticks}],
      series: [{}, ...series.map(one => ({label: one.label, spanGaps: true, ...look(one.role), points: {show: Boolean(one.points) && one.role !== 'ghost', size: 5, fill: look(one.role).stroke}}))]};
  }

  #keys(card, series) {
    card.box.querySelector('.keys').replaceChildren(...series.map(one => {
      const item = document.createElement('li'), line = document.createElement('i'), {stroke, dash} = look(one.role);
      line.style.borderColor = stroke;
      line.style.borderTopStyle = dash ? one.role === 'ghost' ? 'dotted' : 'dashed' : 'solid';
      item.append(line, one.label);
      return item;
    }));
  }

  #width(card) { return Math.max(200, card.box.clientWidth - 24); }

  #fit(card) {
    const width = this.#width(card);
    if (card.chart && card.chart.width !== width) card.chart.setSize({width, height: 210});
  }

  /** Draws all anew, in the colors of the theme. */
  dress() {
    for (const card of this.#cards.values()) {
      card.form = null;
      if (card.drawing) this.#draw(card.measure, card, card.drawing, card.values ?? {});
    }
  }
}

/** A table of the worker as arrays by the names of its columns, each made when it is asked for. */
function by_column({columns, rows, value}) {
  const table = {};
  columns.forEach((name, column) => Object.defineProperty(table, name, {configurable: true, get() {
    const list = Array.from({length: rows}, (_, row) => value[row * columns.length + column]);
    Object.defineProperty(table, name, {value: list});
    return list;
  }}));
  return table;
}
