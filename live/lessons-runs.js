// Several seeds of a scene, before and after a change, each in an engine of its own. Engines are kept for the next exercise.
import {Engine} from './engine.js';

const engines = [], most = () => (navigator.hardwareConcurrency >= 4 ? 2 : 1);

/** Engines that are ready, as many as run side by side. */
async function ready_engines() {
  while (engines.length < most()) {
    const engine = new Engine();
    engines.push({engine, ready: new Promise((resolve, reject) => { engine.on('ready', resolve); engine.on('error', reject); })});
  }
  await Promise.all(engines.map(one => one.ready));
  return engines.map(one => one.engine);
}

/** Runs so many steps. during(part): 0 to 1, now and then. signal stops it. @returns {Promise<object[]>} the tables at the end */
export function run_once(engine, {text, settings, seed, steps}, during, signal) {
  const id = `lesson-${engine.next()}`, stop = new AbortController();
  return new Promise((resolve, reject) => {
    const on = (kind, then) => engine.addEventListener(kind, event => { if (event.detail.id === id) then(event.detail); }, {signal: stop.signal});
    const end = (settle, value) => { stop.abort(); engine.send({kind: 'want', tables: false, solvent: 'none'}); settle(value); };
    let step = 0;
    on('started', () => {
      engine.send({kind: 'want', tables: true, solvent: 'none'});
      engine.send({kind: 'step', steps});
    });
    on('frame', frame => {
      step = frame.step;
      engine.send({kind: 'drawn', id});
    });
    on('tables', message => {
      const at = message.step ?? step;
      during(at / steps, message.tables);
      if (at >= steps) end(resolve, message.tables);
    });
    on('error', message => end(reject, new Error(message.message)));
    signal.addEventListener('abort', () => { engine.send({kind: 'pause'}); end(reject, new Error('stopped')); }, {signal: stop.signal});
    engine.send({kind: 'start', id, text, settings, seed: String(seed)});
  });
}

/** All runs of an exercise: seed after seed, the two scenes in turn. done(which, seed, tables) after each; during(part of all). */
export async function run_all({text, variants, seeds}, done, during, signal) {
  const jobs = Array.from({length: seeds}, (_, seed) => variants.map((variant, which) => ({which, seed: seed + 1, ...variant}))).flat(), total = jobs.length, parts = new Map();
  const tell = () => during([...parts.values()].reduce((sum, part) => sum + part, 0) / total);
  const work = async engine => {
    for (let job = jobs.shift(); job; job = jobs.shift()) {
      const mine = job, tables = await run_once(engine, {text, ...mine}, part => { parts.set(mine, Math.min(1, part)); tell(); }, signal);
      parts.set(mine, 1);
      done(mine.which, mine.seed, tables);
      tell();
    }
  };
  await Promise.all((await ready_engines()).map(work));
}
