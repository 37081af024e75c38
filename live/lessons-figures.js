// Two small figures of an exercise: the value of each seed with the mean and its error, and the curves behind it.
import {draw, picture, line, text, short} from './apart-draw.js';

const WIDTH = 380, LEFT = 14, RIGHT = 14;

/** Mean over seeds and its standard error; NaN for one seed. */
export function over_seeds(values) {
  const mean = values.reduce((sum, x) => sum + x, 0) / values.length, scatter = Math.sqrt(values.reduce((sum, x) => sum + (x - mean) ** 2, 0) / (values.length - 1));
  return {mean, scatter, error: scatter / Math.sqrt(values.length)};
}

/** Round steps between two bounds, some four of them. */
function ticks(low, high) {
  const raw = (high - low) / 4, size = 10 ** Math.floor(Math.log10(raw)), step = [1, 2, 5, 10].map(k => k * size).find(x => x >= raw), all = [];
  for (let k = Math.ceil(low / step); k * step <= high + 1e-9 * step; k++) all.push(k * step);
  return all;
}

/** rows: {label, values, cls}; lines: {value, cls, label}. Bounds hold all of them. */
export function strip(rows, lines) {
  const all = [...rows.flatMap(row => row.values), ...lines.map(one => one.value)].filter(Number.isFinite);
  const low0 = Math.min(...all), high0 = Math.max(...all), pad = (high0 - low0) * 0.08 || Math.abs(high0) * 0.02 || 1, low = low0 - pad, high = high0 + pad;
  const height = 46 * rows.length + 56, x = value => LEFT + (WIDTH - LEFT - RIGHT) * (value - low) / (high - low), svg = picture(WIDTH, height, 'Values of all seeds, with mean and error'), base = height - 24;
  svg.append(line([LEFT, base], [WIDTH - RIGHT, base], 'axis'));
  for (const tick of ticks(low, high)) svg.append(line([x(tick), base], [x(tick), base + 4], 'axis'), text([x(tick), base + 17], short(Math.abs(tick) < 1e-12 * high ? 0 : tick, 3), 'soft'));
  lines.filter(one => Number.isFinite(one.value)).forEach((one, at) => {
    svg.append(line([x(one.value), 24], [x(one.value), base], one.cls), text([Math.min(WIDTH - 60, Math.max(60, x(one.value))), 12 + 11 * (at % 2)], one.label, one.cls === 'guess' ? 'guess-label' : 'soft'));
  });
  rows.forEach((row, at) => {
    const y = 50 + 46 * at;
    svg.append(text([LEFT, y - 8], row.label, row.cls, 'start'));
    row.values.forEach((value, k) => svg.append(draw('circle', {cx: x(value), cy: y + 8 + (k % 3 - 1) * 3, r: 3.5, class: row.cls, 'fill-opacity': 0.45})));
    if (!row.values.length) return;
    const {mean, error} = over_seeds(row.values);
    if (error >= 0) svg.append(line([x(mean - error), y + 8], [x(mean + error), y + 8], `bar ${row.cls}`), ...[-1, 1].map(side => line([x(mean + side * error), y + 1], [x(mean + side * error), y + 15], `bar ${row.cls}`)));
    svg.append(line([x(mean), y - 1], [x(mean), y + 17], `bar ${row.cls}`));
  });
  return svg;
}

/** Mean of curves that end at different places: as far as all of them go. */
function mean_curve(curves) {
  const rows = Math.min(...curves.map(curve => curve.x.length));
  return {x: curves[0].x.slice(0, rows), y: Array.from({length: rows}, (_, at) => curves.reduce((sum, curve) => sum + curve.y[at], 0) / curves.length),
          error: Array.from({length: rows}, (_, at) => over_seeds(curves.map(curve => curve.y[at])).error)};
}

/** rows: {curves, cls}. log: both axes. levels: {value, label} across. */
export function curves(rows, [x_name, y_name], log, levels = []) {
  const means = rows.filter(row => row.curves.length).map(row => ({...mean_curve(row.curves), cls: row.cls})), fits = v => Number.isFinite(v) && (!log || v > 0), of = log ? Math.log10 : x => x;
  const xs = means.flatMap(one => one.x).filter(fits).map(of), ys = [...means.flatMap(one => one.y.filter((_, at) => fits(one.x[at]))), ...levels.map(one => one.value)].filter(fits).map(of);
  const height = 230, bottom = 40, top = 24, left = 56, svg = picture(WIDTH, height, `${y_name} over ${x_name}`);
  if (xs.length < 2) return svg;
  const span = list => { const [a, b] = [Math.min(...list), Math.max(...list)], pad = (b - a) * 0.06 || 0.01; return [a - pad, b + pad]; };
  const [x0, x1] = span(xs), [y0, y1] = span(ys), x = v => left + (WIDTH - left - RIGHT) * (of(v) - x0) / (x1 - x0), y = v => height - bottom - (height - bottom - top) * (of(v) - y0) / (y1 - y0);
  svg.append(line([left, height - bottom], [WIDTH - RIGHT, height - bottom], 'axis'), line([left, top], [left, height - bottom], 'axis'));
  const marks = (a, b) => log ? Array.from({length: Math.floor(b) - Math.ceil(a) + 1}, (_, k) => 10 ** (Math.ceil(a) + k)) : ticks(a, b);
  for (const tick of marks(x0, x1)) svg.append(line([x(tick), height - bottom], [x(tick), height - bottom + 4], 'axis'), text([x(tick), height - bottom + 17], short(Math.abs(tick) < 1e-12 ? 0 : tick, 3), 'soft'));
  for (const tick of marks(y0, y1)) svg.append(line([left - 4, y(tick)], [left, y(tick)], 'axis'), text([left - 6, y(tick) + 4], short(Math.abs(tick) < 1e-12 ? 0 : tick, 3), 'soft', 'end'));
  svg.append(text([(left + WIDTH - RIGHT) / 2, height - 6], x_name, 'soft'), text([6, 14], y_name, 'soft', 'start'));
  for (const {value, label} of levels) svg.append(line([left, y(value)], [WIDTH - RIGHT, y(value)], 'expected'), text([left + 6, y(value) - 5], label, 'soft', 'start'));
  for (const one of means) {
    const kept = one.x.map((_, at) => at).filter(at => fits(one.x[at]) && fits(one.y[at])), every = Math.max(1, Math.ceil(kept.length / 16));
    svg.append(draw('polyline', {points: kept.map(at => `${x(one.x[at]).toFixed(1)},${y(one.y[at]).toFixed(1)}`).join(' '), class: one.cls}));
    kept.filter((_, k) => k % every === every - 1).forEach(at => {
      const low = one.y[at] - one.error[at], high = one.y[at] + one.error[at];
      if (one.error[at] > 0 && fits(low)) svg.append(line([x(one.x[at]), y(low)], [x(one.x[at]), y(high)], `bar ${one.cls}`));
    });
  }
  return svg;
}
