// The controls, drawn from the rows of choices.js. What the library refuses is greyed out, with its words.
import {choices} from './choices.js';
import {fitting} from './scene.js';

const make = (tag, fields = {}, ...children) => {
  const element = Object.assign(document.createElement(tag), fields);
  element.append(...children);
  return element;
};

/** The library's words without the setting, or the place in the file, which the page made. */
export const words_of = refusal => refusal.message.replace(/^(?:--set [^:]*|scene:\d+:\d+): /, '');

export class Controls {
  #form; #wish; #engine; #round = 0; #shown = [];

  /** wish: called with the settings of an option that somebody chose, [path, value] each. */
  constructor(form, engine, wish) {
    this.#form = form;
    this.#engine = engine;
    this.#wish = wish;
    form.addEventListener('submit', event => event.preventDefault());
  }

  /** Draws all controls for a scene that runs. values: of the effective scene; base: without settings. */
  show(values, base, text, settings) {
    const round = ++this.#round;
    this.#shown = [values, base, text, settings];
    const focus = document.activeElement?.closest?.('#controls') ? document.activeElement.id : null;
    this.#form.replaceChildren(...choices.map(choice => this.#draw(choice, values, base)));
    if (focus) document.getElementById(focus)?.focus({preventScroll: true});
    this.#probe(round, values, base, text, settings);
  }

  #draw(choice, values, base) {
    const absent = choice.absent(values), box = make('div', {className: 'control', id: `control-${choice.id}`});
    const watch = make('p', {className: 'watch', id: `watch-${choice.id}`, textContent: choice.watch});
    const why = make('p', {className: 'why', id: `why-${choice.id}`, hidden: absent === null, textContent: absent ?? ''});
    why.setAttribute('aria-live', 'polite');
    if (absent !== null) {
      box.classList.add('off');
      box.append(make('div', {className: 'head'}, make('span', {className: 'name', textContent: choice.label})), why);
      return box;
    }
    box.append(...(choice.look === 'few' ? this.#radios(choice, values, base) : this.#slider(choice, values, base)), watch, why);
    return box;
  }

  #radios(choice, values, base) {
    const now = choice.now(values), group = make('fieldset', {className: 'choices'});
    group.append(make('legend', {textContent: choice.label}));
    group.setAttribute('aria-describedby', `watch-${choice.id} why-${choice.id}`);
    choice.options(values, base).forEach((option, at) => {
      const input = make('input', {type: 'radio', name: choice.id, id: `${choice.id}-${at}`, checked: option.label === now});
      input.addEventListener('change', () => this.#choose(choice, option));
      group.append(make('label', {}, input, option.label));
    });
    return [group];
  }

  #slider(choice, values, base) {
    const options = choice.options(values, base), now = Math.max(0, options.findIndex(option => option.label === choice.now(values)));
    const input = make('input', {type: 'range', id: choice.id, min: '0', max: String(options.length - 1), step: '1', value: String(now)});
    const output = make('output', {htmlFor: choice.id});
    const say = () => {
      const label = options[Number(input.value)].label + (choice.unit ? ` ${choice.unit}` : '');
      output.textContent = label;
      input.setAttribute('aria-valuetext', label);
    };
    input.setAttribute('aria-describedby', `watch-${choice.id} why-${choice.id}`);
    input.addEventListener('input', say);
    input.addEventListener('change', () => this.#choose(choice, options[Number(input.value)]));
    say();
    return [make('div', {className: 'head'}, make('label', {htmlFor: choice.id, textContent: choice.label}), output), input];
  }

  async #choose(choice, option) {
    const refusal = await this.#wish(option.settings);
    if (!refusal) return;
    this.show(...this.#shown);
    this.#say(choice, `“${option.label}” is refused: ${words_of(refusal)}`).classList.add('refused');
  }

  #say(choice, text) {
    const why = document.getElementById(`why-${choice.id}`);
    why.textContent = text;
    why.hidden = !text;
    return why;
  }

  /** Asks the library about each option that is not held, and greys out what it refuses. */
  async #probe(round, values, base, text, settings) {
    for (const choice of choices) {
      if (choice.absent(values) !== null) continue;
      const options = choice.options(values, base), now = choice.now(values), refused = [];
      const asked = choice.look === 'few' ? options : [options.at(-1), options[0]];
      const others = asked.filter(option => option.label !== now), answers = await Promise.all(others.map(option => {
        const changed = new Map([...settings, ...option.settings]);
        return this.#engine.check(fitting(text, changed), [...changed].map(([path, value]) => `${path}=${value}`));
      }));
      if (round !== this.#round) return;
      answers.forEach(({error}, place) => { if (error) refused.push([others[place], error]); });
      this.#grey(choice, options, refused, others.length);
    }
  }

  #grey(choice, options, refused, asked) {
    const box = document.getElementById(`control-${choice.id}`);
    if (!refused.length || !box) return;
    if (choice.look === 'few') {
      for (const [option] of refused) {
        const input = document.getElementById(`${choice.id}-${options.indexOf(option)}`);
        input.disabled = true;
        input.parentElement.classList.add('off');
      }
    } else if (refused.length === asked) {
      box.querySelector('input').disabled = true;
      box.classList.add('off');
    } else {
      return;
    }
    if (!document.getElementById(`why-${choice.id}`).classList.contains('refused')) this.#say(choice, [...new Set(refused.map(([option, error]) =>
      `${choice.look === 'few' ? `“${option.label}”: ` : 'Not in this scene: '}${words_of(error)}`))].join('\n'));
  }
}

/** The switches of the picture: a select and check boxes. changed(looks) is called at each change, and once now. */
export function begin_looks(fieldset, changed) {
  const select = (id, options) => make('select', {id}, ...options.map(([value, label]) => make('option', {value, textContent: label})));
  const solvent = select('look-solvent', [['none', 'hidden'], ['slab', 'in a slab'], ['all', 'all']]);
  const speed = select('look-speed', [['0', 'as fast as it can'], ['100', '100 steps a picture'], ['10', '10 steps a picture'], ['1', '1 step a picture']]);
  const boxes = [['trace', 'Trace of the marked fiber', true], ['contacts', 'Contacts flash', true], ['flow', 'Flow in a slab', false], ['turn', 'Turn slowly', false]]
    .map(([id, label, checked]) => [id, make('input', {type: 'checkbox', id: `look-${id}`, checked}), label]);
  const next = make('button', {type: 'button', id: 'look-next', textContent: 'Mark the next fiber'});
  fieldset.append(make('label', {}, 'Speed', speed), make('label', {}, 'Solvent', solvent), ...boxes.map(([, box, label]) => make('label', {}, box, label)), next);
  fieldset.querySelector('#look-contacts').parentElement.hidden = true; // until a frame has contacts
  const tell = () => changed({solvent: solvent.value, speed: speed.value, ...Object.fromEntries(boxes.map(([id, box]) => [id, box.checked]))});
  fieldset.addEventListener('change', tell);
  tell();
  return {next, solvent, tell};
}
