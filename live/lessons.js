// Exercises of the course in the page: a guess, several seeds before and after one changed line, and what should be seen.
import {make, button, dress, table, with_error, short} from './apart-draw.js';
import {lessons} from './lessons-list.js';
import {run_all} from './lessons-runs.js';
import {strip, curves, over_seeds} from './lessons-figures.js';

const COURSE = 'docs/course.md#exercises';

const kept = (name, value) => {
  try {
    if (value !== undefined) localStorage.setItem(name, value);
    return localStorage.getItem(name) ?? '';
  } catch { return ''; } // private windows keep nothing
};

/** A state of the page as a link. */
export function link_of(lesson, variant) {
  const link = new URLSearchParams({scene: `exercises/${lesson.scene}`});
  variant.settings.forEach(setting => link.append('set', setting));
  return `#${link}`;
}

function begin_lesson(lesson, page) {
  const results = make('div'), line = make('p', {class: 'watch', role: 'status'}), rows = [lesson.before, lesson.after].map((variant, at) => ({label: variant.label, cls: at ? 'two' : 'one', values: [], curves: [], seen: variant.seen}));
  let stop = null;
  const guess = make('input', {class: 'guess', inputmode: 'decimal', value: kept(`guess-${lesson.number}`), autocomplete: 'off', oninput: () => { kept(`guess-${lesson.number}`, guess.value); show(); }});
  const guessed = () => (guess.value.trim() ? Number(guess.value.replace(',', '.').replace('−', '-')) : NaN);
  const answer = make('details', {ontoggle: () => show()}, make('summary', {}, 'What you should see'), make('p', {}, lesson.see));

  function show() {
    if (!rows.some(row => row.values.length)) return;
    const lines = [...(lesson.scatter ? [] : [{value: guessed(), cls: 'guess', label: 'your guess'}]), ...(answer.open ? (lesson.theory ?? []).filter(one => !lesson.log).map(one => ({...one, cls: 'expected'})) : [])];
    const number = row => { const {mean, error, scatter} = over_seeds(row.values); return row.values.length ? [row.label, with_error(mean, error), row.values.length > 1 ? short(Number(scatter.toPrecision(2))) : '–', answer.open ? row.seen : '?'] : [row.label, '–', '–', '?']; };
    results.replaceChildren(strip(rows, lines), table([lesson.quantity, 'mean ± error', 'scatter', lesson.scatter ? 'scatter, in the course' : 'in the course'], rows.map(number), lesson.quantity),
      ...(lesson.curve ? [curves(rows, lesson.axis, lesson.log, answer.open && lesson.log ? lesson.theory : [])] : []));
    if (lesson.scatter && rows.every(row => row.values.length > 1)) {
      const spread = row => { const {scatter} = over_seeds(row.values); return with_error(scatter, scatter / Math.sqrt(2 * (row.values.length - 1))); }; // its error for normal deviates
      results.append(make('p', {}, `Scatter with its error: ${rows.map(row => `${spread(row)} (${row.label})`).join(', ')}.${guess.value ? ` Your guess of the first: ${guess.value}.` : ''}`));
    }
  }

  async function measure() {
    if (stop) { stop.abort(); return; }
    const scene = page.shipped(`exercises/${lesson.scene}`);
    if (!scene) { line.textContent = `The scene exercises/${lesson.scene} is not on this page.`; return; }
    page.run(false);
    rows.forEach(row => { row.values = []; row.curves = []; });
    results.replaceChildren();
    stop = new AbortController();
    const count = Number(seeds.value);
    run.textContent = 'Stop';
    line.textContent = 'Starting …';
    const variants = [lesson.before, lesson.after].map(variant => ({settings: variant.settings, steps: variant.steps ?? lesson.steps})), began = performance.now();
    try {
      await run_all({text: scene.text, variants, seeds: count}, (which, seed, tables) => {
        rows[which].values.push(lesson.value(tables));
        if (lesson.curve) rows[which].curves.push(lesson.curve(tables));
        show();
      }, part => {
        const past = (performance.now() - began) / 1000;
        line.textContent = `${(100 * part).toFixed(0)} % of ${2 * count} runs${part > 0.03 ? `, ${Math.max(1, Math.round(past / part - past))} s to go` : ''}`;
      }, stop.signal);
      line.textContent = `${count} seeds of each, in ${((performance.now() - began) / 1000).toFixed(0)} s. Now unfold what you should see.`;
    } catch (error) {
      line.textContent = error.message === 'stopped' ? 'Stopped.' : error.message;
    }
    stop = null;
    run.textContent = 'Run again';
  }

  const counts = [...new Set([2, 4, 8, 16, lesson.seeds])].sort((a, b) => a - b);
  const seeds = make('select', {}, ...counts.map(count => make('option', {value: count, selected: count === lesson.seeds}, String(count))));
  const run = button('Run', measure, {class: 'primary'});
  const box = make('details', {class: 'lesson', id: `lesson-${lesson.number}`}, make('summary', {}, `${lesson.name ?? lesson.number}. ${lesson.title}`),
    make('p', {}, lesson.question),
    make('p', {}, 'The line that changes: ', make('code', {}, lesson.before.label), ' → ', make('code', {}, lesson.after.label)),
    make('p', {}, make('label', {class: 'guess'}, lesson.guess, guess)),
    make('p', {class: 'buttons'}, run, make('label', {}, 'seeds of each ', seeds)), line, results, answer,
    make('p', {class: 'links'}, 'Open in the picture: ', make('a', {href: link_of(lesson, lesson.before)}, 'before'), make('a', {href: link_of(lesson, lesson.after)}, 'after'),
      'Read: ', make('a', {href: COURSE, rel: 'help'}, `exercise ${lesson.name ?? lesson.number} of the course`)));
  return box;
}

/** Fills the panel. */
export function begin(panel, page) {
  dress();
  panel.classList.add('lessons');
  const boxes = lessons.map(lesson => begin_lesson(lesson, page));
  panel.append(make('p', {}, 'Each exercise changes one line of a scene. Guess first, with a number: it stays in this browser. Then several runs start here, before and after the change, each with a seed (random numbers) of its own. A dot is a run, and the bar is the mean with its standard error. Scatter is the standard deviation of the runs. 0.1202(5) means 0.1202 ± 0.0005.'), ...boxes);
  boxes[0].open = true;
}
