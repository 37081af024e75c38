// Means and their errors from rows that follow each other in time.

const mean_of = list => list.reduce((sum, one) => sum + one, 0) / list.length;

/** Mean and its error from 16 blocks of rows, or from the rows if there are fewer than 32; NaN below 4. */
export function mean_and_error(rows) {
  const kept = rows.filter(Number.isFinite);
  if (kept.length < 4) return [kept.length ? mean_of(kept) : NaN, NaN];
  const blocks = kept.length < 32 ? kept : Array.from({length: 16}, (_, block) => mean_of(kept.slice(Math.floor(block * kept.length / 16), Math.floor((block + 1) * kept.length / 16))));
  const middle = mean_of(blocks);
  return [mean_of(kept), Math.sqrt(blocks.reduce((sum, one) => sum + (one - middle) ** 2, 0) / (blocks.length - 1) / blocks.length)];
}

/** Means from the first row on, at up to 24 times that lie evenly. @returns {{x: number[], y: number[], error: number[]}} */
export function running_means(x, y) {
  const result = {x: [], y: [], error: []}, points = Math.min(24, x.length);
  for (let point = 1; point <= points; point++) {
    const rows = Math.round(point * x.length / points);
    if (rows < 2) continue;
    const [mean, error] = mean_and_error(y.slice(0, rows));
    result.x.push(x[rows - 1]);
    result.y.push(mean);
    result.error.push(error);
  }
  return result;
}
