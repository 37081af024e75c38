// What stands around the fibers: the box, its sliding images, walls, a bead, solvent particles, dumbbells, the flow in a slab.
import * as three from 'three';
import {Strands} from './strands.js';
import {paint, rgb} from './palette.js';

const lines = (points, color, opacity = 1) => {
  const geometry = new three.BufferGeometry();
  geometry.setAttribute('position', new three.Float32BufferAttribute(points, 3));
  return new three.LineSegments(geometry, new three.LineBasicMaterial({color, transparent: opacity < 1, opacity}));
};

function edges([x, y, z]) {
  const points = [], corner = n => [n & 1 ? x : 0, n & 2 ? y : 0, n & 4 ? z : 0];
  for (let n = 0; n < 8; n++) for (const bit of [1, 2, 4]) if (!(n & bit)) points.push(...corner(n), ...corner(n | bit));
  return points;
}

/** An arrow along x from the middle of a plane y = height. */
function arrow_along_x([x, , z], height, length) {
  const head = Math.sign(length) * Math.min(0.8, Math.abs(length) / 2), a = x / 2 - length / 2, b = x / 2 + length / 2, points = [];
  for (const depth of [0, z / 2, z]) points.push(a, height, depth, b, height, depth, b, height, depth, b - head, height, depth - head / 2, b, height, depth, b - head, height, depth + head / 2);
  return points;
}

const dots_vertex = `
  uniform float size; uniform float scale; varying float v_depth;
  void main() { vec4 place = modelViewMatrix * vec4(position, 1.0); v_depth = -place.z; gl_Position = projectionMatrix * place; gl_PointSize = max(1.5, size * scale / -place.z); }`;
const dots_fragment = `
  uniform vec3 color; uniform float opacity;
  void main() { if (dot(gl_PointCoord - 0.5, gl_PointCoord - 0.5) > 0.25) discard; gl_FragColor = vec4(color, opacity); }`;

export class Surroundings {
  constructor(values, info) {
    this.group = new three.Group();
    this.values = values;
    this.cells = info.cells;
    const ink = paint('--ink'), soft = paint('--soft');
    this.group.add(lines(edges(this.cells), soft, 0.8));
    this.#walls(ink);
    this.#images(soft);
    this.#bead();
    this.#dots(info.particles);
    this.#arrows();
    if (values.dumbbells) this.#springs(info.particles);
  }

  #walls(ink) {
    const {walls} = this.values, [x, y, z] = this.cells;
    if (!walls) return;
    const rate = walls.shear_rate ?? 0, speeds = [walls.lower?.[0] || -rate * y / 2, walls.upper?.[0] || rate * y / 2];
    [0, y].forEach((height, upper) => {
      const plate = new three.Mesh(new three.BoxGeometry(x, 0.15, z), new three.MeshBasicMaterial({color: paint('--soft'), transparent: true, opacity: 0.35, depthWrite: false}));
      plate.position.set(x / 2, height + (upper ? 0.075 : -0.075), z / 2);
      this.group.add(plate);
      if (speeds[upper]) this.group.add(lines(arrow_along_x(this.cells, height, Math.sign(speeds[upper]) * x * 0.4), ink));
    });
  }

  /** In a sheared box: outlines of the images above and below, which slide. */
  #images(soft) {
    if (!this.values.shear) return;
    const [x, y] = this.cells;
    this.images = [1, -1].map(side => {
      const image = lines(edges([x, side * y * 0.25, this.cells[2]]), soft, 0.35);
      image.position.y = side > 0 ? y : 0;
      this.group.add(image);
      this.group.add(lines(arrow_along_x(this.cells, side > 0 ? y * 1.25 : -y * 0.25, side * Math.sign(this.values.shear.rate || 1) * x * 0.35), soft));
      return image;
    });
  }

  #bead() {
    if (!this.values.bead) return;
    this.bead = new three.Mesh(new three.SphereGeometry(this.values.bead.radius, 40, 24), new three.MeshLambertMaterial({color: '#8c9aa8'}));
    this.bead.position.set(...(this.values.bead.center ?? [0, 0, 0]));
    this.group.add(new three.HemisphereLight('#ffffff', '#556270', 3), this.bead);
  }

  #dots(particles) {
    const geometry = new three.BufferGeometry();
    geometry.setAttribute('position', new three.BufferAttribute(new Float32Array(3 * Math.max(1, particles)), 3).setUsage(three.DynamicDrawUsage));
    geometry.setDrawRange(0, 0);
    this.dots = new three.Points(geometry, new three.ShaderMaterial({vertexShader: dots_vertex, fragmentShader: dots_fragment, transparent: true, depthWrite: false,
      uniforms: {size: {value: 0.16}, scale: {value: 500}, color: {value: new three.Vector3(...rgb(paint('--soft')))}, opacity: {value: 0.4}}}));
    this.dots.frustumCulled = false;
    this.group.add(this.dots);
  }

  #springs(particles) {
    this.springs = new Strands(particles >> 1);
    for (let at = 0; at < particles >> 1; at++) this.springs.paint(at, rgb(paint('--accent')), 0.05);
    this.group.add(this.springs.mesh);
  }

  #arrows() {
    const [x, y] = this.cells;
    this.wide = Math.min(x, 24); this.high = Math.min(y, 24);
    this.sums = new Float64Array(3 * this.wide * this.high);
    this.flow = new Strands(3 * this.wide * this.high);
    for (let at = 0; at < this.flow.room; at++) this.flow.paint(at, rgb(paint('--ink')), 0.07);
    this.group.add(this.flow.mesh);
  }

  /** Takes what a frame has. looks: of controls.js. */
  take(frame, looks) {
    if (this.images) this.images.forEach((image, at) => { image.position.x = at === 0 ? frame.offset ?? 0 : -(frame.offset ?? 0); });
    if (this.bead && frame.bead) this.#place_bead(frame.bead);
    const shown = looks.solvent !== 'none' && frame.solvent, {geometry} = this.dots;
    geometry.setDrawRange(0, 0);
    if (shown && !this.springs) {
      const places = frame.solvent.position, room = geometry.attributes.position.array;
      room.set(places.length > room.length ? places.subarray(0, room.length) : places);
      geometry.attributes.position.needsUpdate = true;
      geometry.setDrawRange(0, Math.min(places.length, room.length) / 3);
    }
    if (this.springs) this.#stretch(looks.solvent === 'all' || this.cells[2] === 1 ? frame.solvent : undefined);
    if (looks.flow && frame.solvent) this.#stream(frame.solvent);
    else this.flow.count = 0;
  }

  #place_bead(place) {
    this.bead.position.set(...place.map((x, axis) => this.values.walls && axis === 1 ? x : x - Math.floor(x / this.cells[axis]) * this.cells[axis]));
  }

  /** Springs between the particles 2p and 2p + 1, by the nearest image. */
  #stretch(solvent) {
    const {springs, cells} = this;
    springs.count = 0;
    if (!solvent) return;
    const place = solvent.position, pairs = Math.min(springs.room, place.length / 6 | 0), ends = springs.ends.array;
    for (let pair = 0; pair < pairs; pair++) {
      for (let axis = 0; axis < 3; axis++) {
        const a = place[6 * pair + axis], edge = cells[axis], b = place[6 * pair + 3 + axis];
        ends[6 * pair + axis] = a;
        ends[6 * pair + 3 + axis] = this.values.walls && axis === 1 ? b : b - Math.round((b - a) / edge) * edge;
      }
    }
    springs.count = pairs;
    springs.moved();
  }

  /** Mean velocity in cells of the slab in the middle; memory of some 30 frames. */
  #stream({position, velocity}) {
    const [x, y, z] = this.cells, {wide, high, sums, flow} = this;
    for (let at = 0; at < sums.length; at++) sums[at] *= 0.97;
    for (let at = 0; at < position.length; at += 3) {
      if (z > 1 && Math.abs(position[at + 2] - z / 2) > 0.5) continue;
      const column = Math.min(wide - 1, position[at] / x * wide | 0), row = Math.min(high - 1, position[at + 1] / y * high | 0), cell = 3 * (row * wide + column);
      sums[cell] += velocity[at];
      sums[cell + 1] += velocity[at + 1];
      sums[cell + 2]++;
    }
    let square = 0;
    for (let at = 0; at < sums.length; at += 3) if (sums[at + 2] > 0) square = Math.max(square, (sums[at] ** 2 + sums[at + 1] ** 2) / sums[at + 2] ** 2);
    this.fastest = Math.sqrt(square);
    const longest = 1.3 * x / wide / (this.fastest || 1), ends = flow.ends.array;
    let piece = 0;
    const add = (ax, ay, bx, by) => ends.set([ax, ay, z / 2, bx, by, z / 2], 6 * piece++);
    for (let row = 0; row < high; row++) for (let column = 0; column < wide; column++) {
      const cell = 3 * (row * wide + column);
      if (!(sums[cell + 2] > 0)) continue;
      const vx = sums[cell] / sums[cell + 2] * longest, vy = sums[cell + 1] / sums[cell + 2] * longest, ax = (column + 0.5) * x / wide, ay = (row + 0.5) * y / high, bx = ax + vx, by = ay + vy;
      add(ax, ay, bx, by);
      add(bx, by, bx - 0.3 * vx - 0.15 * vy, by - 0.3 * vy + 0.15 * vx);
      add(bx, by, bx - 0.3 * vx + 0.15 * vy, by - 0.3 * vy - 0.15 * vx);
    }
    flow.count = piece;
    flow.moved();
  }
}
