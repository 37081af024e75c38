/*
 * The C code as WebAssembly, in Node, beside the native program: state hashes of all shipped scenes, with and without
 * vectors; what `uncross check` prints; tables; messages about bad scenes; speed. There is no tolerance.
 *
 * usage: node bits.mjs BUILD
 */
import {spawnSync} from 'node:child_process';
import {existsSync, mkdtempSync, readdirSync, readFileSync, rmSync, writeFileSync} from 'node:fs';
import {join, resolve} from 'node:path';
import {pathToFileURL} from 'node:url';
import {Tally} from './tally.mjs';

const build = resolve(process.argv[2]), page = join(build, 'live'), tally = new Tally();
const {loadLibrary, hasVectors, UncrossError} = await import(pathToFileURL(join(page, 'library.js')));
const {scenes: all, bench} = JSON.parse(readFileSync(join(page, 'scenes.json'))), scenes = all.filter(scene => scene.hash);
const work = mkdtempSync(join(build, 'live-work', 'bits-'));

function native(...words) {
  const {status, stdout, stderr} = spawnSync(join(build, 'uncross'), words, {encoding: 'utf8', maxBuffer: 1 << 26});
  return {status, stdout, stderr};
}

/* Hashes after 8 steps that all compilers and processors give. */
const written = new Map(readFileSync('tests/kernel/shipped.txt', 'utf8').trim().split('\n').map(line => line.split(/\s+/)));

function compareScene(library, name, scene) {
  const made = library.scene(scene.file, scene.text), sim = made.start();
  sim.advance(8);
  tally.equal(`${name}: ${scene.file} after 8 steps, as tests/kernel/shipped.txt has it`, BigInt(`0x${sim.hash}`), BigInt(`0x${written.get(scene.file)}`));
  const seen = scene.name === 'dense' ? sim.advanceAndSee(scene.steps - 8) : sim.advance(scene.steps - 8);
  tally.equal(`${name}: ${scene.file} after ${scene.steps} steps, as the native program`, sim.hash, scene.hash);
  tally.equal(`${name}: ${scene.file} as \`uncross check\` tells of it`, made.report, native('check', scene.file).stdout);
  if (seen)
    tally.is(`${name}: bonds of contacts are told`, seen.length > 100 && seen.every(bond => bond >= 0 && bond < sim.vertices));
  sim.free();
  made.free();
}

/* Files of a native run against tables of the page: the same doubles. */
function compareTables(library, scene) {
  const folder = join(work, scene.name), made = library.scene(scene.file, scene.text, ['observe.from=0', 'steps=100']), sim = made.start();
  native('run', scene.file, '--out', folder, '--quiet', '--steps', '100', '--set', 'observe.from=0');
  sim.advance(100);
  for (const table of sim.tables) {
    const path = join(folder, `${table.name}.csv`);
    if (!tally.is(`${scene.file}: ${table.name}.csv is a table of the native run, too`, existsSync(path)))
      continue;
    const [head, ...rows] = readFileSync(path, 'utf8').trim().split('\n').filter(line => !line.startsWith('#'));
    tally.equal(`${scene.file}: columns of ${table.name}`, table.columns.join(), head);
    tally.equal(`${scene.file}: numbers of ${table.name}`, [...table.value].map(String).join(' '), rows.flatMap(row => row.split(',')).map(x => String(Number(x))).join(' '));
  }
  tally.is(`${scene.file}: has tables`, sim.tables.length > 0);
  sim.free();
  made.free();
}

/* Texts that a scene cannot be, most of them: seeds and finds of the fuzzer. */
function badTexts() {
  const folder = join(work, 'corpus'), decoder = new TextDecoder('utf-8', {fatal: true}), texts = [];
  spawnSync('tests/fuzz/make_corpus', [folder]);
  for (const name of readdirSync(folder).sort()) {
    let text = '';
    try {
      text = decoder.decode(readFileSync(join(folder, name)));
    } catch { /* not a text */ }
    if (text && !text.includes('\0'))
      texts.push(text);
  }
  return texts;
}

function messageOf(library, path, text) {
  let scene;
  try {
    scene = library.scene(path, text);
    scene.check();
    return '';
  } catch (error) {
    if (!(error instanceof UncrossError))
      throw error;
    return `uncross: ${error.message}\n`;
  } finally {
    scene?.free();
  }
}

function compareMessages(library) {
  const path = join(work, 'bad.yaml'), texts = badTexts();
  let refused = 0;
  for (const text of texts) {
    writeFileSync(path, text);
    const {status, stderr} = native('check', path), ours = messageOf(library, path, text);
    refused += status === 2;
    if (ours !== stderr)
      tally.equal(`what is said of ${JSON.stringify(text.slice(0, 60))}`, ours, stderr);
  }
  tally.is(`${texts.length} texts, ${refused} of them refused, in the same words`, refused >= 100);
}

function compareSpeed(libraries) {
  const path = join(work, 'bench.yaml'), steps = 300, best = new Map();
  writeFileSync(path, bench.text);
  const keep = (name, rate) => best.set(name, Math.max(rate, best.get(name) ?? 0));
  for (let round = 0; round < 3; round++) {
    for (const [name, library] of libraries) {
      const scene = library.scene('bench', bench.text), sim = scene.start();
      sim.advance(20);
      const began = performance.now();
      sim.advance(steps);
      keep(name, 1000 * steps / (performance.now() - began));
      sim.free();
      scene.free();
    }
    const folder = join(work, `bench-${round}`);
    native('run', path, '--out', folder, '--quiet', '--steps', String(steps));
    keep('native', JSON.parse(readFileSync(join(folder, 'run.json'))).steps_per_second);
  }
  for (const [name, rate] of best)
    console.log(`speed: ${name} ${rate.toFixed(0)} steps/s of ${bench.vertices} vertices and ${bench.particles} particles, ${(rate / best.get('native')).toFixed(2)} of native (best of 3)`);
}

try {
  tally.is('this Node has vectors', hasVectors());
  const libraries = new Map();
  for (const name of ['uncross-simd', 'uncross'])
    libraries.set(name, await loadLibrary(readFileSync(join(page, `${name}.wasm`))));
  for (const [name, library] of libraries)
    for (const scene of scenes)
      compareScene(library, name, scene);
  const library = libraries.get('uncross-simd');
  for (const name of ['dense', 'couette', 'dumbbells', 'bead'])
    compareTables(library, scenes.find(scene => scene.name === name));
  compareMessages(library);
  compareSpeed(libraries);
} finally {
  rmSync(work, {recursive: true});
}
tally.end();
