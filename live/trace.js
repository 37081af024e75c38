// The past of the marked fiber: up to 48 of its shapes. When they are full, every second one is left out, so the
// trace always reaches back to where it began.
import {Strands} from './strands.js';
import {rgb} from './palette.js';

const shapes_at_most = 48;

export class Trace {
  /** first, bonds: the bonds of the fiber follow each other. */
  constructor(first, bonds, radius) {
    this.first = first;
    this.bonds = bonds;
    this.radius = radius;
    this.strands = new Strands(Math.max(1, bonds * shapes_at_most), 0.16);
    this.shapes = [];
    this.interval = 0;          // steps between shapes; doubled when full
    this.last = -1;
  }

  /** Keeps the ends [bonds][6] at this step, if its time has come. @returns {boolean} whether it was kept */
  keep(step, ends) {
    if (this.last >= 0 && step - this.last < this.interval) return false;
    if (this.last >= 0 && this.interval === 0) this.interval = Math.max(1, step - this.last);
    this.shapes.push(ends.slice());
    this.last = step;
    if (this.shapes.length > shapes_at_most) {
      this.shapes = this.shapes.filter((_, at) => at % 2 === 0);
      this.interval *= 2;
    }
    return true;
  }

  /** Draws all shapes; older ones nearer to the color of the ground. */
  draw(color, ground) {
    const own = rgb(color), back = rgb(ground), {strands} = this;
    let at = 0;
    this.shapes.forEach((ends, age) => {
      const fresh = 0.35 + 0.65 * (age + 1) / this.shapes.length, tint = own.map((part, c) => back[c] + (part - back[c]) * fresh);
      strands.ends.array.set(ends, 6 * at);
      for (let bond = 0; bond < this.bonds; bond++) strands.paint(at++, tint, this.radius);
    });
    strands.count = at;
    strands.moved();
  }
}
