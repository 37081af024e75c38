/*
 * Each page of the site in headless Chromium: no wider than a phone, nothing from another host, nothing in the console. On some pages,
 * light and dark, axe-core finds nothing serious. The search finds a key and a function by name.
 *
 * usage: node pages.mjs BUILD [PAGE ...]     (a look at the width of these alone; $CHROMIUM: the browser, else chromium)
 */
import {createServer} from 'node:http';
import {createRequire} from 'node:module';
import {existsSync, readFileSync, readdirSync, statSync} from 'node:fs';
import {extname, join, relative, resolve} from 'node:path';
import {execFileSync} from 'node:child_process';
import {Tally} from '../live/tally.mjs';

const PHONE = {width: 390, height: 844}, DESKTOP = {width: 1280, height: 900};
const TYPES = {'.html': 'text/html', '.js': 'text/javascript', '.mjs': 'text/javascript', '.css': 'text/css', '.svg': 'image/svg+xml', '.png': 'image/png', '.wasm': 'application/wasm', '.json': 'application/json'};
/* Pages of each sort: words, tables, figures, formulas, both interfaces, lines of a file, search. */
const LOOKED_AT = ['index.html', 'README.html', 'docs/course.html', 'docs/scene.html', 'docs/equations.html', 'docs/claims/tube.html', 'interface/c.html', 'interface/python.html',
  'files/src/step.c.html', 'search.html'];
/* What is looked for, and the page that must be among the first five found. */
const SEARCHED = [['crossing.rule', 'docs/scene.html#key-crossing-rule'], ['observe.stress.every', 'docs/scene.html#key-observe-stress-every'], ['viscosity', 'docs/how-to.html'], ['uncross_sim_advance', 'interface/c.html'], ['cross-links', 'README.html'], ['crosslinks', 'README.html']];

const build = resolve(process.argv[2]), folder = join(build, 'site'), tally = new Tally();
const packaged = createRequire(join(build, 'live-work/npm/package.json')), {chromium} = packaged('playwright-core');

const server = createServer((request, response) => {
  const path = decodeURIComponent(new URL(request.url, 'http://page').pathname), file = join(folder, path.endsWith('/') ? `${path}index.html` : path);
  if (!existsSync(file))
    return response.writeHead(path === '/favicon.ico' ? 204 : 404).end();
  return response.writeHead(200, {'Content-Type': TYPES[extname(file)] ?? 'text/plain'}).end(readFileSync(file));
});
await new Promise(done => server.listen(0, '127.0.0.1', done));
const address = `http://127.0.0.1:${server.address().port}/`;

const all = readdirSync(folder, {recursive: true}).filter(name => name.endsWith('.html') && !name.startsWith('live/') && statSync(join(folder, name)).isFile()).sort();
/* Pages of files differ in their lines only, which scroll: one in eight is looked at. */
const chosen = process.argv.slice(3);
const pages = chosen.length > 0 ? chosen : all.filter((name, k) => !name.startsWith('files/') || k % 8 === 0 || LOOKED_AT.includes(name));

const browser = await chromium.launch({executablePath: process.env.CHROMIUM ?? execFileSync('which', ['chromium'], {encoding: 'utf8'}).trim(), args: ['--no-sandbox']});
try {
  const wide = [], elsewhere = [], errors = [];
  const page = await browser.newPage({viewport: PHONE});
  page.on('request', request => { if (!request.url().startsWith(address) && !request.url().startsWith('data:')) elsewhere.push(`${page.url()}: ${request.url()}`); });
  page.on('console', message => { if (message.type() === 'error') errors.push(`${page.url()}: ${message.text()}`); });
  page.on('pageerror', error => errors.push(`${page.url()}: ${error}`));
  for (const name of pages) {
    await page.goto(address + name);
    const {width, widest} = await page.evaluate(phone => {
      /* the theme hides what is too wide in a box that scrolls as a whole */
      const width = Math.max(...[document.scrollingElement, ...document.querySelectorAll('.page, .main, .content')].map(box => box.scrollWidth));
      const out = width <= phone ? [] : [...document.querySelectorAll('article *')].filter(e => e.getBoundingClientRect().right > phone && !e.closest('.table-wrapper, pre, .formula'));
      return {width, widest: out.slice(0, 2).map(e => e.outerHTML.slice(0, 120)).join(' | ')};
    }, PHONE.width);
    if (width > PHONE.width)
      wide.push(`${name}: ${width} px: ${widest}`);
  }
  tally.equal(`no page is wider than ${PHONE.width} px`, wide.join('\n'), '');
  if (chosen.length === 0)
    tally.is(`${pages.length} of ${all.length} pages were seen`, pages.length > 90 && LOOKED_AT.every(name => pages.includes(name)));

  for (const theme of chosen.length > 0 ? [] : ['light', 'dark']) {
    const context = await browser.newContext({viewport: DESKTOP, colorScheme: theme}), looked = await context.newPage();
    await looked.goto(`${address}index.html`);
    const paper = await looked.evaluate(() => getComputedStyle(document.body).backgroundColor.match(/\d+/g).slice(0, 3).reduce((sum, part) => sum + Number(part), 0));
    tally.is(`the page is ${theme} (${paper})`, theme === 'dark' ? paper < 150 : paper > 600);
    for (const name of LOOKED_AT) {
      await looked.goto(address + name);
      await looked.addScriptTag({path: packaged.resolve('axe-core/axe.min.js')});
      const {violations} = await looked.evaluate(() => window.axe.run());
      const serious = violations.filter(({impact}) => impact === 'serious' || impact === 'critical');
      tally.equal(`axe-core, ${theme}, ${name}`, serious.map(({id, nodes}) => `${id} (${nodes.length}): ${nodes[0].html} ${nodes[0].failureSummary}`).join('\n'), '');
    }
    await context.close();
  }

  for (const [words, wanted] of chosen.length > 0 ? [] : SEARCHED) {
    await page.goto(`${address}search.html?q=${encodeURIComponent(words)}`);
    await page.waitForSelector('#search-results li a', {timeout: 15_000}).catch(() => {});
    const found = await page.$$eval('#search-results li a', links => links.slice(0, 5).map(a => a.href));
    tally.is(`search for ${words} has ${wanted} among ${found.map(url => relative(address, url)).join(', ')}`, found.some(url => url.includes(wanted)));
  }
  /* A link to a key arrives at its row, below the header, on a phone and a desktop; the front page opens the program that runs. */
  for (const viewport of chosen.length > 0 ? [] : [PHONE, DESKTOP]) {
    await page.setViewportSize(viewport);
    await page.goto(`${address}docs/scene.html#key-crossing-rule`);
    const [top, header, bottom] = await page.evaluate(() => {
      const row = document.querySelector(':target').closest('tr').getBoundingClientRect();
      return [row.top, document.querySelector('.mobile-header').getBoundingClientRect().bottom, innerHeight - row.bottom];
    });
    tally.is(`at ${viewport.width} px the row of a key begins at ${top}, below ${header}, and ends ${bottom} above the lower edge`, top >= header && bottom > 0);
    await page.goto(`${address}index.html`);
    await page.click('.shown a:has(img)');
    tally.is(`its picture opens ${relative(address, page.url())}`, page.url().startsWith(`${address}live/index.html`));
  }
  tally.equal('nothing is asked of other hosts', elsewhere.join('\n'), '');
  tally.equal('errors in the console', errors.join('\n'), '');
} finally {
  await browser.close();
  server.close();
}
tally.end();
