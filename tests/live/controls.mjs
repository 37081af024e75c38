// Uses every control of the page once, as a person would, and says what does not do what it says.
// `use_controls(page, address)` is given a page of playwright-core; by itself: node controls.mjs ADDRESS.

const value_of = (page, id) => page.$eval(`#${id}`, element => element.textContent);
const patience = 120_000; // ms; a machine that does other things too draws in software slowly
const wait = (page, condition, argument, timeout = patience) => page.waitForFunction(condition, argument, {timeout, polling: 100});
const stepped = (page, beyond) => wait(page, least => Number(document.getElementById('steps').textContent) > least, beyond);
const idle = page => wait(page, () => document.body.dataset.opening === 'no' && !document.getElementById('run').disabled);
const link_says = (page, text) => wait(page, part => decodeURIComponent(location.hash.replaceAll('+', ' ')).includes(part), text);

/** Opens a link in the page that is there, which follows it without loading anew. */
async function go(page, address, link) {
  if (page.url().startsWith(address)) await idle(page);
  const opened = await page.evaluate(() => document.body?.dataset.opened ?? '').catch(() => '');
  if (!page.url().startsWith(address)) await page.goto(`${address}${link}`);
  else await page.evaluate(hash => { if (location.hash === hash) dispatchEvent(new Event('hashchange')); else location.hash = hash; }, link);
  await wait(page, before => document.body.dataset.opened !== undefined && document.body.dataset.opened !== before && document.body.dataset.opening === 'no', opened);
}

/** One row for each control: where it is, how it is used, and what the link must say then. */
const uses = [
  {control: 'hydrodynamics', use: page => page.check('#hydrodynamics-1'), link: 'solvent.hydrodynamics=false'},
  {control: 'crossing', use: page => page.check('#crossing-0'), link: 'crossing.forbidden=false'},
  {control: 'crossing', use: page => page.check('#crossing-1'), link: 'crossing.rule=sequential'},
  {control: 'count', use: page => slide(page, 'count', -1), link: 'fibers.0.count='},
  {control: 'stiffness', use: page => slide(page, 'stiffness', -1), link: 'fibers.0.persistence_length='},
  {control: 'density', use: page => slide(page, 'density', 1), link: 'solvent.per_cell=8'},
  {control: 'acceleration', use: page => slide(page, 'acceleration', 1), link: 'solvent.acceleration=[0.003, 0, 0]'},
  {control: 'thermostat', use: page => page.check('#thermostat-1'), link: 'solvent.thermostat=rescale'},
  {control: 'time-step', use: page => slide(page, 'time-step', -1), link: 'time_step=0.005'},
];

async function slide(page, id, by) {
  await page.focus(`#${id}`);
  await page.keyboard.press(by > 0 ? 'ArrowRight' : 'ArrowLeft');
}

/** @returns {Promise<string[]>} what went wrong, a sentence each */
export async function use_controls(page, address) {
  page.setDefaultTimeout(patience);
  const wrong = [], start = '#scene=dense&set=fibers.0.count%3D40';
  const must = (what, holds) => { if (!holds) wrong.push(what); };

  for (const {control, use, link} of uses) {
    await go(page, address, start);
    await use(page);
    await link_says(page, link)
      .catch(() => wrong.push(`${control}: the link does not say ${link}, but ${decodeURIComponent(page.url())}`));
    await idle(page);
    await page.click('#step');
    await stepped(page, 0).catch(() => wrong.push(`${control}: no step after ${link}`));
  }

  await go(page, address, '#text=cut');
  must('nothing is said of a link that is cut', (await value_of(page, 'message')).includes('cannot be read'));

  await go(page, address, '#scene=shear');
  await slide(page, 'shear', 1);
  await link_says(page, 'shear.rate=').catch(() => wrong.push('shear: the link does not say shear.rate'));

  await go(page, address, start);
  await page.click('#run');
  await stepped(page, 60);
  await page.click('#run');
  await wait(page, () => /at step/.test(document.getElementById('hash').textContent)).catch(() => wrong.push('no hash after a pause'));
  const paused = Number(await value_of(page, 'steps'));
  await page.click('#step');
  await stepped(page, paused).catch(() => wrong.push('one step makes no step'));
  must('a plot of the energy is missing', await page.$('#plot-energy'));
  await page.click('#restart');
  await wait(page, () => document.getElementById('steps').textContent === '0').catch(() => wrong.push('restart does not begin at step 0'));
  await page.fill('#seed', 'seven');
  await page.press('#seed', 'Enter');
  must('nothing is said of a seed that is none', (await value_of(page, 'message')).includes('“seven” is no seed'));
  await page.fill('#seed', '7');
  await page.press('#seed', 'Enter');
  await link_says(page, 'seed=7').catch(() => wrong.push('the link does not say the seed'));

  await idle(page);
  await page.selectOption('#look-speed', '10');
  await page.selectOption('#look-solvent', 'all');
  for (const look of ['trace', 'contacts', 'flow', 'turn']) if (await page.isVisible(`#look-${look}`)) await page.click(`#look-${look}`);
  await page.click('#look-next');
  await page.focus('#view');
  for (const key of ['ArrowLeft', 'ArrowUp', '+', '-', '0', ' ']) await page.keyboard.press(key);
  await stepped(page, 0).catch(() => wrong.push('the space bar in the picture does not run'));
  await page.click('#run');
  await page.click('#theme');
  must('the other theme is not shown', await page.evaluate(() => document.documentElement.dataset.theme) === 'dark');

  await page.focus('#tab-controls');
  await page.keyboard.press('ArrowRight');
  must('an arrow does not choose the next tab', await page.isVisible('#scene-panel'));
  const [file] = await Promise.all([page.waitForEvent('download'), page.click('#download')]);
  must(`the file is ${file.suggestedFilename()}`, file.suggestedFilename() === 'dense.yaml');

  await page.fill('#text', 'box: [8, 8, 8]\ntime_step: 0.02\nsteps: 10\nsolvent: {per_cell: 5, collision_interval: 0.02}\nnonsense: 1\n');
  await page.click('#use-text');
  await page.waitForSelector('#text-error:not([hidden])').catch(() => wrong.push('a wrong scene is not refused'));
  must('the line that is wrong is not marked', (await page.$$eval('#lines b', marks => marks.map(mark => mark.textContent.trim()))).join() === '5');
  await page.fill('#text', 'box: [8, 8, 8]\ntime_step: 0.02\nsteps: 10\nsolvent: {per_cell: 5, collision_interval: 0.02}\n');
  await page.click('#use-text');
  await link_says(page, 'text=').catch(() => wrong.push('the link does not hold a scene of one’s own'));
  await idle(page);
  const own = page.url();
  await page.goto('about:blank');
  await go(page, address, own.slice(own.indexOf('#')));
  must('a link with a scene of one’s own does not open it', await page.$eval('#scene', list => list.value) === 'own');

  await page.click('#tab-scene');
  await page.click('#copy');
  await wait(page, () => document.getElementById('copied').textContent !== '').catch(() => wrong.push('copying the link says nothing'));
  const small = size => `box: [${size}, 8, 8]\ntime_step: 0.02\nsteps: 10\nsolvent: {per_cell: 5, collision_interval: 0.02}\n`, box = size =>
    wait(page, edge => document.getElementById('text').value.includes(`box: [${edge}, 8, 8]`) && document.body.dataset.opening === 'no', size);
  await page.setInputFiles('#open', {name: 'mine.yaml', mimeType: 'text/yaml', buffer: Buffer.from(small(10))});
  await box(10).catch(() => wrong.push('a file that is opened does not run'));
  await page.evaluate(text => {
    const given = new DataTransfer();
    given.items.add(new File([text], 'dropped.yaml', {type: 'text/yaml'}));
    dispatchEvent(Object.assign(new Event('drop', {cancelable: true}), {dataTransfer: given}));
  }, small(12));
  await box(12).catch(() => wrong.push('a file that is dropped does not run'));
  must('an opened file is refused', !await page.isVisible('#text-error'));
  await page.click('#tab-numbers');
  must('what check prints is not shown', /Parameters/.test(await value_of(page, 'check')));
  await page.click('#bench');
  await wait(page, () => /steps a second/.test(document.getElementById('speed').textContent)).catch(() => wrong.push('the speed is not measured'));
  await go(page, address, '#scene=thick');
  await wait(page, () => document.getElementById('crossing-1')?.disabled).catch(() => wrong.push('thick fibers: the paper’s rule is not greyed out'));
  must('thick fibers: no words say why', /allowed/.test(await value_of(page, 'why-crossing')));
  await page.selectOption('#scene', 'solvent');
  await wait(page, () => location.hash === '#scene=solvent').catch(() => wrong.push('the list of scenes does not open one'));
  return wrong;
}

/** Loads the page, takes the net away, and loads it once more. @returns {Promise<string[]>} what went wrong */
export async function do_without_net(page, address) {
  page.setDefaultTimeout(patience);
  await page.goto(`${address}#scene=shear`);
  await idle(page);
  await wait(page, async () => (await (await caches.open('uncross-live')).keys()).some(kept => kept.url.endsWith('scenes.json')));
  await page.waitForTimeout(2000);
  await page.context().setOffline(true);
  try {
    await page.goto('about:blank');
    await page.goto(`${address}#scene=couette`);
    await idle(page);
    await page.click('#step');
    await stepped(page, 0);
    return [];
  } catch (error) {
    return [`without the net: ${error.message}`];
  } finally {
    await page.context().setOffline(false);
  }
}

if (process.argv[1] === new URL(import.meta.url).pathname) {
  const {chromium} = await import('playwright-core');
  const browser = await chromium.launch({executablePath: '/usr/bin/chromium', args: ['--no-sandbox', '--use-gl=angle', '--use-angle=swiftshader', '--enable-unsafe-swiftshader', '--disable-gpu-compositing']});
  const page = await browser.newPage({colorScheme: 'light'}), errors = [];
  page.on('console', message => { if (message.type() === 'error') errors.push(message.text()); });
  page.on('pageerror', error => errors.push(error.stack));
  const wrong = [...await use_controls(page, process.argv[2]), ...await do_without_net(page, process.argv[2]), ...errors];
  console.log(wrong.length ? wrong.join('\n') : 'every control was used');
  await browser.close();
  process.exit(wrong.length ? 1 : 0);
}
