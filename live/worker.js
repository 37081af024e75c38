/*
 * The simulation of a page, in a worker of its own: it looks at its messages at least every SLICE, or after one step if
 * that takes longer. Messages are plain objects with a `kind`; docs/live.md lists them. A frame is sent when the page
 * has drawn the one before.
 */
import {hasVectors, loadLibrary} from './library.js';

const SLICE = 12;       /* ms of steps between looks at messages */
const FRAME = 1000 / 60;
const TABLES = 500;     /* ms between tables */
const RATE = 500;       /* ms over which the rate is taken */
const CONTACTS = 4096;  /* numbers of bonds in a frame at most: a page that nobody looks at draws none */

let library, shipped;
let sim = null, scene = null, id = null;
let running = false, wanted = 0;      /* wanted: steps still to make of a `step` */
let stepsPerFrame = 0, sinceFrame = 0; /* 0: as many as there is time for */
let hashAt = 0;         /* the step after which the hash is told; 0: none */
let drawn = true, lastFrame = 0, lastTables = 0;
let want = {solvent: 'none', tables: false, contacts: false};
let contacts = [];      /* bonds that met since the last frame */
let pace = 1;           /* steps in a slice */
let rate = {steps: 0, ms: 0, value: 0};

/* The next turn comes after the messages that wait: a timer would be late by 4 ms. */
const turn = new MessageChannel();
let turning = false;
turn.port1.onmessage = () => { turning = false; guard(work); };
function goOn() {
  if (!turning) {
    turning = true;
    turn.port2.postMessage(0);
  }
}

/* --- what is sent --------------------------------------------------------------------------------------------------- */

function told({code = 1, codeName, cause, message, step, entity, value, limit, line, column}) {
  return {code, codeName, cause, message, step, entity, value, limit, line, column};
}

function sendError(error, of = id) {
  postMessage({kind: 'error', id: of, ...told(error)});
}

/* Calls f; what goes wrong is told, and stops what runs. */
function guard(f, ...given) {
  try {
    f(...given);
  } catch (error) {
    running = false;
    wanted = 0;
    sendError(error);
  }
}

function sendFrame() {
  const positions = Float32Array.from(sim.positions), frame = {
    kind: 'frame', id, step: sim.step, time: sim.time, positions, counts: sim.counts, conserved: sim.conserved, rate: rate.value,
    running: running || wanted > 0, bead: sim.bead, offset: sim.offset,
  };
  const move = [positions.buffer];
  if (want.solvent !== 'none') {
    frame.solvent = solventOf(want);
    move.push(frame.solvent.position.buffer, frame.solvent.velocity.buffer);
  }
  if (want.contacts)
    frame.contacts = contacts;
  contacts = [];
  drawn = false;
  lastFrame = performance.now();
  sinceFrame = 0;
  postMessage(frame, move);
}

/* All of the solvent, or what is in a slab: {axis, at, width} in a0, the middle of the box unless it is said. */
function solventOf({solvent, axis = 2, at = sim.cells[axis] / 2, width = 1}) {
  const {position, velocity} = sim.solvent;
  if (solvent === 'all')
    return {position: Float32Array.from(position), velocity: Float32Array.from(velocity)};
  const inside = [];
  for (let k = axis; k < position.length; k += 3)
    if (Math.abs(position[k] - at) <= width / 2)
      inside.push(k - axis);
  const pick = from => Float32Array.from({length: 3 * inside.length}, (_, k) => from[inside[Math.trunc(k / 3)] + k % 3]);
  return {position: pick(position), velocity: pick(velocity)};
}

function sendTables() {
  lastTables = performance.now();
  postMessage({kind: 'tables', id, step: sim.step, tables: sim.tables});
}

/* --- what is done --------------------------------------------------------------------------------------------------- */

/* Makes steps for a slice, at most so many. */
function advance(most) {
  const began = performance.now();
  let made = 0, now = began;
  while (made < most && now - began < SLICE) {
    const steps = Math.max(1, Math.min(pace, most - made));
    if (want.contacts && contacts.length < CONTACTS)
      contacts.push(...sim.advanceAndSee(steps));
    else
      sim.advance(steps);
    made += steps;
    const before = now;
    now = performance.now();
    pace = Math.max(1, Math.min(2 * pace, Math.floor(steps * SLICE / 3 / Math.max(now - before, 0.01))));
  }
  rate.steps += made;
  rate.ms += now - began;
  if (rate.ms > RATE)
    rate = {steps: 0, ms: 0, value: 1000 * rate.steps / rate.ms};
  else if (rate.value === 0)
    rate.value = 1000 * rate.steps / Math.max(rate.ms, 0.1);
  return made;
}

/* A slice: steps, then what is due. */
function work() {
  if (!sim || !(running || wanted > 0))
    return;
  if (stepsPerFrame > 0 && sinceFrame >= stepsPerFrame && !drawn)
    return; /* `drawn` goes on */
  const most = Math.min(wanted > 0 ? wanted : Infinity, stepsPerFrame > 0 ? stepsPerFrame - sinceFrame : Infinity,
                        hashAt > sim.step ? hashAt - sim.step : Infinity);
  const made = advance(most), now = performance.now();
  sinceFrame += made;
  wanted = Math.max(0, wanted - made);
  if (sim.step === hashAt)
    messages.hash();
  const over = !running && wanted === 0;
  const full = stepsPerFrame > 0 ? sinceFrame >= stepsPerFrame : now - lastFrame >= FRAME;
  if (over)
    return end();
  if (drawn && full)
    sendFrame();
  if (want.tables && now - lastTables >= TABLES)
    sendTables();
  goOn();
}

/* The scene is read and started before the old one is given up. */
function open({text, settings, seed}) {
  const made = library.scene('scene', text, settings, seed);
  try {
    made.check();
    return {scene: made, sim: made.start()};
  } catch (error) {
    made.free();
    throw error;
  }
}

function close() {
  sim?.free();
  scene?.free();
  sim = scene = null;
}

/* Speed, by a simulation of its own: of a suspension that is the same everywhere, if no scene is given. */
function bench({seconds = 2, text = shipped.bench.text, settings = [], seed}) {
  const own = open({text, settings, seed});
  let steps = 0, ms = 0;
  const part = () => guard(() => {
    const began = performance.now();
    for (let now = began; now - began < 50; now = performance.now(), steps++)
      own.sim.advance(1);
    ms += performance.now() - began;
    if (ms < 1000 * seconds)
      setTimeout(part);
    else {
      postMessage({kind: 'bench', id, steps, seconds: ms / 1000, rate: 1000 * steps / ms, vectors: library.vectors,
                   vertices: own.sim.vertices, particles: own.sim.particles, hash: own.sim.hash});
      own.sim.free();
      own.scene.free();
    }
  });
  part();
}

/* After the last step of several: the last frame waits for no other. */
function end() {
  if (!sim)
    return;
  sendFrame();
  if (want.tables)
    sendTables();
}

const messages = {
  start(m) {
    running = false;
    wanted = 0;
    let own;
    try {
      own = open(m);
    } catch (error) {
      return sendError(error, m.id);
    }
    close();
    ({scene, sim} = own);
    id = m.id;
    sinceFrame = 0;
    hashAt = m.hashAt || 0;
    pace = 1;
    rate = {steps: 0, ms: 0, value: 0};
    const {cells, vertices, particles, fibers, kinds, next, first, fiberOf, kindOf, mass, warnings} = sim;
    postMessage({kind: 'started', id, text: scene.text, check: scene.report, warnings,
                 info: {cells, dt: scene.number('time_step'), vertices, particles, fibers, kinds, next, first, fiberOf, kindOf, mass}});
    sendFrame();
  },
  check({id: asked, text, settings, seed}) {
    let own = null;
    try {
      own = library.scene('scene', text, settings, seed);
      own.check();
      postMessage({kind: 'checked', id: asked, error: null, text: own.text, check: own.report});
    } catch (error) {
      postMessage({kind: 'checked', id: asked, error: told(error)});
    } finally {
      own?.free();
    }
  },
  run(m) {
    stepsPerFrame = m.stepsPerFrame || 0;
    running = true;
    goOn();
  },
  pause() {
    const ran = running || wanted > 0;
    running = false;
    wanted = 0;
    if (ran)
      end();
  },
  step(m) {
    running = false;
    stepsPerFrame = 0;
    wanted += m.steps;
    goOn();
  },
  want(m) {
    want = {...want, ...m};
    if (sim && !running && drawn)
      sendFrame();
    if (sim && m.tables)
      sendTables();
  },
  drawn() {
    drawn = true;
    goOn();
  },
  hash() {
    postMessage({kind: 'hash', id, step: sim.step, hash: sim.hash});
  },
  bench,
  snapshot() {
    postMessage({kind: 'snapshot', id, step: sim.step, time: sim.time, positions: sim.positions, velocities: sim.velocities, solvent: sim.solvent});
  },
};

onmessage = event => guard(m => {
  if (!messages[m.kind])
    throw new Error(`no message '${m.kind}'; allowed: ${Object.keys(messages).join(', ')}`);
  if (!sim && !['start', 'check', 'want', 'drawn', 'bench', 'pause'].includes(m.kind))
    throw new Error(`'${m.kind}' needs a scene that was started`);
  messages[m.kind](m);
}, event.data);

/* Bytes of a file beside this one, in browsers and (tests) in Node. */
async function fetched(name) {
  const response = await fetch(new URL(name, import.meta.url));
  if (!response.ok)
    throw new Error(`${name}: ${response.status} ${response.statusText}`);
  return response;
}

/* plain, in the address of this file: without vectors, even where there are some. */
async function begin() {
  const vectors = hasVectors() && !new URL(import.meta.url).searchParams.has('plain');
  library = await loadLibrary(await fetched(vectors ? 'uncross-simd.wasm' : 'uncross.wasm'));
  library.vectors = vectors;
  shipped = await (await fetched('scenes.json')).json();
  postMessage({...shipped, kind: 'ready', version: library.version, vectors});
}
begin().catch(sendError);
