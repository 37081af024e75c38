/*
 * The npm package, as somebody who has installed it uses it, in a folder of its own and without the net: shipped scenes have the
 * hashes of tests/kernel/shipped.txt, with and without vectors; the tarball has the same bytes when it is made again.
 *
 * usage: node package.mjs BUILD
 */
import {spawnSync} from 'node:child_process';
import {mkdtempSync, readdirSync, readFileSync, rmSync, writeFileSync} from 'node:fs';
import {join, resolve} from 'node:path';
import {Tally} from './tally.mjs';

const folder = join(resolve(process.argv[2]), 'npm'), tally = new Tally();
const archive = readdirSync(folder).find(name => /^uncross-.*\.tgz$/.test(name));
const work = mkdtempSync(join(folder, 'user-'));

const USER = `
import {readFileSync} from 'node:fs';
import {load, UncrossError} from 'uncross';
const [tree, vectors, ...names] = process.argv.slice(2), library = await load({vectors: vectors === 'true'});
console.log(library.version);
for (const name of names) {
  const scene = library.scene(name, readFileSync(tree + '/' + name, 'utf8')), run = scene.start();
  run.advance(8);
  console.log(name, String(run.hash).padStart(16, '0'));
}
try {
  library.scene('bad.yaml', 'box: [4, 4, 4]\\nbocks: 1\\n');
} catch (error) {
  console.log(error instanceof UncrossError, error.line, error.message);
}
`;

function call(where, program, ...words) {
  const {status, stdout, stderr} = spawnSync(program, words, {cwd: where, encoding: 'utf8'});
  tally.is(`${program} ${words[0]}: exit status ${status}: ${stderr}`, status === 0);
  return stdout;
}

try {
  writeFileSync(join(work, 'package.json'), '{"name": "user", "private": true, "type": "module"}\n');
  writeFileSync(join(work, 'user.js'), USER);
  call(work, 'npm', 'install', '--offline', '--no-audit', '--no-fund', '--loglevel=error', join(folder, archive));
  const {version} = JSON.parse(readFileSync(join(work, 'node_modules/uncross/package.json')));
  const known = readFileSync('tests/kernel/shipped.txt', 'utf8').trim().split('\n').filter(line => /(semidilute|bead-slit|rings)\.yaml/.test(line));
  tally.equal('scenes that are tried', known.length, 3);
  for (const vectors of [true, false]) {
    const told = call(work, 'node', 'user.js', process.cwd(), String(vectors), ...known.map(line => line.split(' ')[0])).trim().split('\n');
    tally.equal(`version, vectors ${vectors}`, told[0], version);
    tally.equal(`hashes, vectors ${vectors}`, told.slice(1, 4).join(', '), known.join(', '));
    tally.is(`a scene that is refused: ${told[4]}`, /^true 2 bad\.yaml:2:\d+: /.test(told[4]));
  }
  const again = call(join(folder, 'package'), 'npm', 'pack', '--silent', '--pack-destination', work).trim();
  tally.is('the same bytes again', readFileSync(join(work, again)).equals(readFileSync(join(folder, archive))));
} finally {
  rmSync(work, {recursive: true});
}
tally.end();
