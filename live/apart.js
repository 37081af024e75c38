// A step taken apart by hand: four small pictures, one at a time.
import {make, choice, dress} from './apart-draw.js';
import {begin as begin_cells} from './apart-cells.js';
import {begin as begin_triangle} from './apart-triangle.js';
import {begin as begin_contact} from './apart-contact.js';
import {begin as begin_break} from './apart-break.js';

const parts = [
  ['cells', '1 Collide', 'Stream, bin, rotate', begin_cells],
  ['triangle', '2 Cross?', 'Does a moving bond cross another one?', begin_triangle],
  ['contact', '3 Touch', 'One contact: its time and its impulse', begin_contact],
  ['break', '4 Break it', 'Break it, and see which test finds it', begin_break],
];

/** Fills the panel. A part is made when it is first shown. */
export function begin(panel) {
  dress();
  panel.classList.add('apart');
  const made = new Map(), place = make('div');
  const show = name => {
    if (!made.has(name)) {
      const [, , title, fill] = parts.find(part => part[0] === name), box = make('section', {'aria-label': title}, make('h2', {}, title));
      made.set(name, box);
      place.append(box);
      fill(box);
    }
    for (const [other, box] of made) box.hidden = other !== name;
  };
  panel.append(choice('Parts of a step', parts.map(([name, label]) => [name, label]), show).box, place);
  show('cells');
}
