// The page: its state, and what happens when something of it changes.
import {Engine} from './engine.js';
import {View} from './view.js';
import {Plots} from './plots.js';
import {Controls, begin_looks} from './controls.js';
import {choices} from './choices.js';
import {Editor, download} from './editor.js';
import {begin_tabs} from './tabs.js';
import {begin_theme} from './palette.js';
import {begin_legend} from './legend.js';
import {Hashes} from './hashes.js';
import {keep_files} from './offline.js';
import {read_link, write_link, settings_of} from './state.js';
import {values_of, value_at, as_text, wanted_tables, written, fitting, lines_of_check} from './scene.js';
import {beginnings, words_of_scene} from './catalog.js';
import {make} from './apart-draw.js';
import {begin as begin_apart} from './apart.js';
import {begin as begin_lessons} from './lessons.js';

const at = id => document.getElementById(id);
const engine = new Engine();
const now = {state: null, id: null, values: null, base: null, check: '', text: '', info: null, running: false, opening: 0, time: 0, step: 0};
let scenes = [], looks = {}, pending = false, view = null;

try {
  view = new View(at('view'), fiber => mark(fiber));
} catch {
  at('no-picture').hidden = false;
  at('view').hidden = true;
}
const legend = begin_legend(at('legend'), at('scale'));
const hashes = new Hashes(at('hash'), at('verdict'), at('native'), at('progress'));
const plots = new Plots(at('plots'), {measure: 'energy', press: () => other_rule(), label: values =>
  !values.fibers || !values.crossing?.forbidden || values.fibers.some(kind => kind.diameter > 0) ? null :
    values.crossing.rule === 'sequential' ? 'Run the event-driven rule beside it' : 'Run the paper’s rule beside it'});
const controls = new Controls(at('controls'), engine, wish);
const editor = new Editor(text => open({scene: 'own', text, settings: new Map(), seed: null}));

// --- scenes ---------------------------------------------------------------------------------------------------------

const shipped = name => scenes.find(scene => scene.name === name);
const text_of = state => state.text ?? shipped(state.scene)?.text;

function list_scenes() {
  const group = (label, options) => {
    const element = Object.assign(document.createElement('optgroup'), {label});
    element.append(...options.map(([value, text]) => new Option(text, value)));
    return options.length ? element : '';
  };
  const named = list => list.map(scene => [scene.name, [scene.name.replace(/^exercises\//, ''), words_of_scene(scene)[0]].filter(Boolean).join(': ')]);
  at('scene').replaceChildren(group('Begin here', beginnings.map((one, place) => [`begin:${place}`, one.label])),
    group('Scenes of the program', named(scenes.filter(scene => !scene.name.startsWith('exercises/')))),
    group('Exercises of the course', named(scenes.filter(scene => scene.name.startsWith('exercises/')))), new Option('your own scene', 'own'));
  at('scene').lastChild.hidden = true;
}

const beginning_of = state => beginnings.findIndex(one => state.text === null && one.scene === state.scene && one.settings.length === state.settings.size &&
  one.settings.length > 0 && one.settings.every(([path, value]) => state.settings.get(path) === value));

function show_scene() {
  const {state} = now, begin = beginning_of(state), select = at('scene');
  select.lastChild.hidden = state.text === null;
  select.value = state.text !== null ? 'own' : begin >= 0 ? `begin:${begin}` : state.scene;
  at('about').textContent = begin >= 0 ? beginnings[begin].about : state.text !== null ? 'A scene of your own.' : words_of_scene(shipped(state.scene))[1];
  at('seed').value = state.seed ?? now.values.seed;
  editor.show(state.settings.size ? now.text : text_of(state));
  at('check').replaceChildren(...lines_of_check(now.check.replace(/^[^]*?(?=\nParameters )/, '').trim()).map(({name, value, more}) =>
    make('span', {}, make('span', {}, name, ...(more ? ['  ', make('i', {}, more)] : [])), ...(value ? [' ', make('b', {}, value)] : []), '\n')));
  at('command').textContent = `uncross run ${state.scene.replace(/.*\//, '')}.yaml --out run`;
}

/** Opens a state: checks it, and starts it if the library takes it. @returns {Promise<object|null>} the refusal */
async function open(state, options) {
  document.body.dataset.opening = 'yes'; // until the worker has started it, or it is refused
  const refusal = await begin(state, options);
  if (refusal) document.body.dataset.opening = 'no';
  return refusal;
}

async function begin(state, {run, keep = false} = {}) {
  const round = ++now.opening, source = text_of(state), settings = settings_of(state);
  if (source === undefined) return refuse({message: `There is no scene “${state.scene}”. The list has all of them.`});
  const text = fitting(source, state.settings), checked = await engine.check(text, settings, state.seed ?? undefined);
  if (round !== now.opening) return null;
  if (checked.error) return refuse(checked.error);
  const values = values_of(checked.text), plain = state.settings.size ? await engine.check(source, []) : checked, tables = [];
  for (const group of wanted_tables(values)) {
    const asked = group.map(([path, value]) => `${path}=${value}`);
    if (!(await engine.check(text, [...settings, ...tables, ...asked])).error) tables.push(...asked);
    if (round !== now.opening) return null;
  }
  const same = now.state !== null && source === text_of(now.state);
  Object.assign(now, {state, values, base: plain.error ? {...values} : values_of(plain.text), id: engine.next(), text: checked.text, check: checked.check ?? '', wanted: run ?? now.running, running: false});
  now.base.written = written(source);
  const ghost = plots.begin(same || keep), from = values.observe?.from ?? 0;
  at('ghost').replaceChildren(...(ghost ? ['The last run stays in grey, dotted. ', Object.assign(document.createElement('a'), {href: now.link, textContent: 'Back to it'}), '. '] : []),
    from > 0 ? `Averages (profile, order, angle, stress) begin at step ${from}, when the flow is steady.` : '');
  at('ghost').hidden = !ghost && !from;
  say(null);
  const pristine = state.text === null && !state.settings.size && state.seed === null && shipped(state.scene).hash ? shipped(state.scene) : null;
  hashes.begin(pristine, state);
  engine.send({kind: 'start', id: now.id, text, settings: [...settings, ...tables], seed: state.seed ?? undefined, hashAt: pristine?.steps});
  const link = now.link = await write_link(state);
  if (round === now.opening && link !== location.hash) history.replaceState(null, '', link);
  return null;
}

function refuse(refusal) {
  say(refusal.message);
  return refusal;
}

function say(text) {
  at('message').hidden = !text;
  at('message').textContent = text ?? '';
}

/** Somebody wants settings on top of the state. Those that the scene has by itself are left out of the link. */
async function wish(settings) {
  const changed = new Map(now.state.settings);
  for (const [path, value] of settings) {
    const own = value_at(now.base, path) ?? value_at(now.base.written ?? {}, path);
    if (own === undefined ? value === '0' : as_text(own) === value) changed.delete(path);
    else changed.set(path, value);
  }
  const refusal = await open({...now.state, settings: changed});
  if (refusal) say(null);
  return refusal;
}

/** Runs the other rule of crossing, to be seen beside the last one. */
function other_rule() {
  const other = now.values.crossing.rule === 'sequential' ? 'event-driven' : 'the paper’s rule', crossing = choices.find(choice => choice.id === 'crossing');
  now.running = true;
  wish(crossing.options(now.values, now.base).find(option => option.label === other).settings);
}

// --- run ------------------------------------------------------------------------------------------------------------

function run(on) {
  now.running = on;
  engine.send(on ? {kind: 'run', stepsPerFrame: Number(looks.speed)} : {kind: 'pause'});
  show_running();
}

function show_running() { at('run').textContent = now.running ? 'Pause' : 'Run'; }

const want = () => engine.send({kind: 'want', tables: true, contacts: looks.contacts, solvent: looks.flow && looks.solvent === 'none' ? 'slab' : looks.solvent});

function mark(fiber) {
  view?.mark(fiber);
  show_legend();
}

const show_legend = () => legend(now.values, now.info, view, looks);

engine.on('ready', async ({version, vectors, scenes: list}) => {
  scenes = list;
  at('version').textContent = `${version}, ${vectors ? 'with' : 'without'} 128-bit vectors`;
  list_scenes();
  const first = beginnings[0], refusal = await open_link({run: false});
  keep_files(['worker.js', 'library.js', 'scenes.json', 'uncross.wasm', 'uncross-simd.wasm']);
  if (refusal) await open({...first, text: null, settings: new Map(first.settings), seed: null}, {run: false}).then(() => say(refusal.message));
});

/** Opens what the address says. @returns {Promise<object|null>} the refusal */
async function open_link(options) {
  const fallback = {...beginnings[0], text: null, settings: new Map(beginnings[0].settings), seed: null};
  let damaged = false;
  const state = await read_link(location.hash, fallback).catch(() => { damaged = true; return fallback; });
  const refusal = await open(state, options);
  if (damaged && !refusal) say('The scene in this link cannot be read, perhaps because the link was cut. Shown is the first scene of the list.');
  return refusal;
}

engine.on('started', message => {
  if (message.id !== now.id) return;
  Object.assign(document.body.dataset, {opening: 'no', opened: message.id});
  now.info = message.info;
  now.check = message.check ?? now.check;
  now.step = now.time = 0;
  now.hashed = -1;
  for (const id of ['run', 'step', 'restart', 'bench']) at(id).disabled = false;
  const solvent = now.values.dumbbells ? 'all' : now.info.fibers || now.values.bead ? null : 'slab';
  if (solvent && looks.solvent === 'none') { at('look-solvent').value = solvent; switches.tell(); }
  view?.begin(now.info, now.values);
  for (const id of ['look-trace', 'look-next']) (id === 'look-next' ? at(id) : at(id).parentElement).hidden = !now.info.fibers;
  show_scene();
  show_legend();
  at('warnings').textContent = (message.warnings ?? []).map(text => text.startsWith('warning') ? text : `warning: ${text}`).join('\n');
  controls.show(now.values, now.base, text_of(now.state), now.state.settings);
  want();
  if (now.wanted || now.running) run(true);
  else show_running();
});

engine.on('frame', frame => {
  if (frame.id !== now.id) return;
  [now.step, now.time] = [frame.step, frame.time];
  at('steps').textContent = String(frame.step);
  at('time').textContent = frame.time.toFixed(2);
  at('rate').textContent = now.running ? String(Math.round(frame.rate ?? 0)) : '0';
  hashes.step(frame.step);
  if (!frame.running && frame.step !== now.hashed) engine.send({kind: 'hash'});
  if (frame.contacts) at('look-contacts').parentElement.hidden = false;
  view?.take(frame);
  if (!view) engine.send({kind: 'drawn', id: frame.id});
  pending = Boolean(view);
});

engine.on('tables', message => {
  if (message.id !== now.id || !now.info) return;
  plots.take(message.tables, {values: now.values, check: now.check, info: now.info, time: now.time, kind: now.values.fibers?.[now.info.kindOf[view?.marked ?? 0]]?.name ?? ''});
});

engine.on('hash', message => { if (message.id === undefined || message.id === now.id) { now.hashed = message.step; hashes.take(message); } });

engine.on('error', message => {
  if (message.id !== undefined && message.id !== now.id) return;
  document.body.dataset.opening = 'no';
  now.running = false;
  show_running();
  say(message.message);
});

const pictures = {since: performance.now(), count: 0};
function loop() {
  requestAnimationFrame(loop);
  const drawn = view?.draw(), past = performance.now() - pictures.since;
  if (drawn) pictures.count++;
  if (past > 1000) {
    at('pictures').textContent = (pictures.count * 1000 / past).toFixed(0);
    [pictures.since, pictures.count] = [performance.now(), 0];
  }
  if (!drawn && pending && view?.stale) return; // the frame waits for its picture
  if (!pending) return;
  pending = false;
  engine.send({kind: 'drawn', id: now.id});
  legend.scale(looks.flow ? view?.around?.fastest : undefined);
}

// --- what is pressed ------------------------------------------------------------------------------------------------

at('run').addEventListener('click', () => run(!now.running));
at('step').addEventListener('click', () => {
  if (now.running) run(false);
  engine.send({kind: 'step', steps: 1});
});
at('restart').addEventListener('click', () => open(now.state));
at('seed').addEventListener('change', event => {
  const seed = event.target.value.trim();
  if (!/^[0-9]{1,20}$/.test(seed)) return say(`“${seed}” is no seed; allowed: a whole number from 0 to 18446744073709551615.`);
  open({...now.state, seed: seed === String(now.base.seed) ? null : seed});
});
at('scene').addEventListener('change', event => {
  const [kind, place] = event.target.value.split(':'), begin = kind === 'begin' ? beginnings[place] : {scene: kind, settings: []};
  if (kind !== 'own') open({scene: begin.scene, text: null, settings: new Map(begin.settings), seed: null});
});
at('view').addEventListener('keydown', event => {
  if (event.key !== ' ' || at('run').disabled) return;
  run(!now.running);
  event.preventDefault();
});
at('bench').addEventListener('click', () => {
  if (now.running) run(false);
  at('bench').disabled = true;
  at('speed').textContent = 'measuring for 3 seconds …';
  engine.send({kind: 'bench', seconds: 3, text: now.text, seed: now.state.seed ?? undefined});
});
engine.on('bench', ({rate, vertices, particles}) => {
  at('bench').disabled = false;
  at('speed').textContent = `${Math.round(rate)} steps a second, ${vertices.toLocaleString('en')} vertices and ${particles.toLocaleString('en')} particles, without pictures.`;
});
at('download').addEventListener('click', () => download(`${now.state.scene.replace(/.*\//, '')}.yaml`, now.text));
at('copy').addEventListener('click', async () => {
  try {
    await navigator.clipboard.writeText(location.href);
    at('copied').textContent = 'The link is copied.';
  } catch {
    at('copied').textContent = location.href;
  }
});
addEventListener('hashchange', () => open_link());

begin_tabs(document.querySelector('[role="tablist"]'));
const switches = begin_looks(at('looks'), chosen => {
  looks = chosen;
  if (view) {
    view.looks = looks;
    if (view.last && view.trace) view.take(view.last);
  }
  show_legend();
  if (!now.info) return;
  want();
  if (now.running) run(true); // at another speed
});
switches.next.addEventListener('click', () => mark((view?.marked ?? 0) + 1));
begin_theme(at('theme'), () => { view?.dress(); plots.dress(); show_legend(); });

/** What the panels of a step taken apart and of the exercises may use. */
const page = {engine, now, open, shipped, run, beginnings};
for (const [name, fill] of [['apart', begin_apart], ['lessons', begin_lessons]]) {
  at(`tab-${name}`).hidden = !fill;
  fill?.(at(`${name}-panel`), page);
}
loop();
