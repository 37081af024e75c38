// The picture: fibers in their box, by three.js. One draw call for all bonds, one for the trace; drawn when something is new.
import * as three from 'three';
import {OrbitControls} from './packages/three/OrbitControls.js';
import {Strands, Fold} from './strands.js';
import {Surroundings} from './surroundings.js';
import {Trace} from './trace.js';
import {kinds as kind_colors, marked as marked_color, theme, paint, rgb} from './palette.js';

const thin = 0.09; // radius, a0, at which lines without thickness are drawn

export class View {
  /** Throws where the browser has no WebGL 2. looks: of controls.js; marked(fiber) is called at a click. */
  constructor(canvas, on_mark) {
    this.canvas = canvas;
    this.renderer = new three.WebGLRenderer({canvas, antialias: !software(), powerPreference: 'high-performance'});
    this.slow = software();
    this.camera = new three.PerspectiveCamera(32, 1, 0.1, 4000);
    this.orbit = new OrbitControls(this.camera, canvas);
    this.orbit.enablePan = false;
    this.orbit.addEventListener('change', () => { this.stale = true; });
    this.looks = {solvent: 'none', trace: true, contacts: true, flow: false, turn: false};
    this.marked = 0;
    this.sharpness = this.slow ? 1 : Math.min(2, devicePixelRatio);
    this.stale = true;
    this.frames = 0;
    this.#listen(on_mark);
    new ResizeObserver(() => this.#resize()).observe(canvas);
  }

  #listen(on_mark) {
    let down = null;
    this.canvas.addEventListener('pointerdown', event => { down = [event.clientX, event.clientY]; });
    this.canvas.addEventListener('pointerup', event => {
      if (down && Math.hypot(event.clientX - down[0], event.clientY - down[1]) < 4) {
        const fiber = this.#fiber_at(event);
        if (fiber !== null) on_mark(fiber);
      }
      down = null;
    });
    this.canvas.addEventListener('keydown', event => {
      const turn = {ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1]}[event.key], zoom = {'+': 0.9, '=': 0.9, '-': 1.1}[event.key];
      if (turn) this.#turn(turn[0] * 0.12, turn[1] * 0.12);
      else if (zoom) this.#zoom(zoom);
      else if (event.key === '0') this.look();
      else return;
      event.preventDefault();
    });
  }

  #turn(around, up) {
    const way = this.camera.position.clone().sub(this.orbit.target), place = new three.Spherical().setFromVector3(way);
    place.theta += around;
    place.phi = Math.min(Math.PI - 0.05, Math.max(0.05, place.phi + up));
    this.camera.position.copy(this.orbit.target).add(way.setFromSpherical(place));
    this.orbit.update();
    this.stale = true;
  }

  #zoom(factor) {
    this.camera.position.sub(this.orbit.target).multiplyScalar(factor).add(this.orbit.target);
    this.orbit.update();
    this.stale = true;
  }

  #resize() {
    const {clientWidth: width, clientHeight: height} = this.canvas;
    if (!width || !height) return;
    this.renderer.setPixelRatio(this.sharpness);
    this.renderer.setSize(width, height, false);
    const narrower = this.camera.aspect !== width / height;
    this.camera.aspect = width / height;
    this.camera.updateProjectionMatrix();
    if (narrower && this.info && !this.frames) this.look();
    this.stale = true;
  }

  /** Turns the camera to where the whole box is seen. */
  look() {
    const [x, y, z] = this.info.cells, size = Math.max(x, y, z === 1 ? 0 : z), middle = new three.Vector3(x / 2, y / 2, z / 2);
    const distance = (z === 1 ? 1.95 : 3.0) * size / Math.min(1, this.camera.aspect * 0.95);
    const way = z === 1 ? new three.Vector3(0, 0, 1) : new three.Vector3(0.52, 0.34, 0.78);
    this.camera.position.copy(middle).addScaledVector(way.normalize(), distance);
    this.orbit.target.copy(middle);
    this.orbit.minDistance = size * 0.2;
    this.orbit.maxDistance = size * 8;
    this.orbit.update();
    this.stale = true;
  }

  /** A new simulation. info: of the worker; values: of the effective scene. */
  begin(info, values) {
    const same = this.info && info.cells.every((edge, axis) => edge === this.info.cells[axis]);
    this.info = info;
    this.values = values;
    this.frames = 0;
    this.last = null;
    this.bonds = [];
    for (let fiber = 0; fiber < info.fibers; fiber++)
      for (let at = info.first[fiber]; at < info.first[fiber + 1]; at++) if (info.next[at] >= 0) this.bonds.push([at, info.next[at], fiber]);
    this.place_of = new Int32Array(info.vertices).fill(-1);
    this.bonds.forEach(([from], at) => { this.place_of[from] = at; });
    this.marked = Math.min(this.marked, Math.max(0, info.fibers - 1));
    this.fold = new Fold(info.cells, Boolean(values.walls));
    this.dress();
    if (!same) this.look();
  }

  /** Radius at which fibers of a kind are drawn. */
  radius(kind) { return Math.max(this.values.fibers?.[kind]?.diameter / 2 || 0, thin); }

  /** Makes everything anew, in the colors of the theme. */
  dress() {
    if (!this.info) return;
    this.world?.traverse(part => { part.geometry?.dispose(); part.material?.dispose?.(); });
    this.world = new three.Scene();
    this.world.background = new three.Color(paint('--space'));
    this.haze = rgb(paint('--space'));
    this.strands = new Strands(Math.max(1, this.bonds.length));
    this.strands.count = this.bonds.length;
    this.around = new Surroundings(this.values, this.info);
    this.world.add(this.strands.mesh, this.around.group);
    this.trace = null;
    this.#tint();
    this.#begin_trace();
    if (this.last) this.take(this.last);
    this.stale = true;
  }

  #tint() {
    const colors = kind_colors[theme()].map(rgb), own = rgb(marked_color[theme()]), spark = rgb(theme() === 'dark' ? '#ffffff' : '#000000');
    this.strands.material.uniforms.spark.value.set(...spark);
    this.bonds.forEach(([, , fiber], at) => {
      const kind = this.info.kindOf[fiber], is_marked = fiber === this.marked;
      const shade = 0.82 + 0.36 * (fiber * 0.618034 % 1); // neighbors in the list differ, so that one can follow a fiber
      this.strands.paint(at, is_marked ? own : colors[kind % colors.length].map(part => Math.min(1, part * shade)), this.radius(kind) * (is_marked ? 1.7 : 1));
    });
  }

  #begin_trace() {
    if (this.trace) this.world.remove(this.trace.strands.mesh);
    this.trace?.strands.dispose();
    const bonds = this.bonds.filter(([, , fiber]) => fiber === this.marked);
    this.trace = new Trace(this.bonds.indexOf(bonds[0]), bonds.length, bonds.length ? this.radius(this.info.kindOf[this.marked]) * 1.1 : thin);
    this.world.add(this.trace.strands.mesh);
  }

  /** Marks a fiber; its trace begins anew. */
  mark(fiber) {
    if (!this.info?.fibers) return;
    this.marked = (fiber + this.info.fibers) % this.info.fibers;
    this.#tint();
    this.#begin_trace();
    if (this.last) this.take(this.last);
  }

  /** Takes a frame of the worker; it is drawn at the next chance. */
  take(frame) {
    const {positions: place} = frame, ends = this.strands.ends.array, {fold} = this;
    this.last = frame;
    this.frames++;
    fold.offset = frame.offset ?? 0;
    this.bonds.forEach(([from, to], at) => {
      const a = 3 * from, b = 3 * to, shift = fold.find((place[a] + place[b]) / 2, (place[a + 1] + place[b + 1]) / 2, (place[a + 2] + place[b + 2]) / 2);
      for (let axis = 0; axis < 3; axis++) {
        ends[6 * at + axis] = place[a + axis] + shift[axis];
        ends[6 * at + 3 + axis] = place[b + axis] + shift[axis];
      }
    });
    this.strands.moved();
    const {first, bonds} = this.trace;
    if (bonds && this.trace.keep(frame.step, ends.subarray(6 * first, 6 * (first + bonds))))
      this.trace.draw(marked_color[theme()], paint('--space'));
    this.trace.strands.mesh.visible = this.looks.trace;
    if (this.looks.contacts && frame.contacts) for (const bond of frame.contacts) if (this.place_of[bond] >= 0) this.strands.flash(this.place_of[bond], this.#clock());
    if (frame.contacts?.length) this.flashing = performance.now() + 1200;
    this.around.take(frame, this.looks);
    this.stale = true;
  }

  #clock() { return performance.now() / 1000 % 10000; }

  /** Draws, if anything is new. @returns {boolean} whether it drew */
  draw() {
    if (!this.world) return false;
    if (this.looks.turn) this.#turn(0.004, 0);
    if (!this.stale && !(this.flashing > performance.now())) return false;
    if (this.slow && performance.now() - (this.drawn ?? 0) < 70) return false; // drawing in software leaves the processor to the run
    this.stale = false;
    const distance = this.camera.position.distanceTo(this.orbit.target), size = Math.max(...this.info.cells);
    for (const strands of [this.strands, this.trace.strands, this.around.flow, this.around.springs].filter(Boolean)) {
      const {uniforms} = strands.material;
      uniforms.now.value = this.#clock();
      uniforms.reach.value.set(distance - size * 0.6, distance + size * 0.9);
      uniforms.haze.value.set(...this.haze);
    }
    this.around.dots.material.uniforms.scale.value = this.renderer.domElement.height / (2 * Math.tan(this.camera.fov * Math.PI / 360));
    this.renderer.render(this.world, this.camera);
    this.#adapt(performance.now());
    return true;
  }

  /** Fewer points where pictures follow each other slowly. */
  #adapt(now) {
    const since = now - (this.drawn ?? now), [slow, least] = this.slow ? [180, 0.5] : [60, 0.7];
    this.drawn = now;
    if (since > 1500) return; // nothing was to be drawn
    this.cost = (this.cost ?? since) * 0.9 + since * 0.1;
    if (this.cost < slow || this.sharpness <= least) return;
    this.sharpness *= 0.85;
    this.cost = slow / 2;
    this.#resize();
  }

  /** The fiber nearest to a click, within 14 points; null if none. */
  #fiber_at(event) {
    const box = this.canvas.getBoundingClientRect(), point = new three.Vector3(), ends = this.strands?.ends.array;
    let best = 14, fiber = null;
    this.bonds?.forEach((bond, at) => {
      point.set(ends[6 * at], ends[6 * at + 1], ends[6 * at + 2]).project(this.camera);
      const away = Math.hypot((point.x + 1) / 2 * box.width - (event.clientX - box.left), (1 - point.y) / 2 * box.height - (event.clientY - box.top)) + point.z;
      if (away < best) [best, fiber] = [away, bond[2]];
    });
    return fiber;
  }
}

/** Whether the browser draws in software: then without smoothing, and with fewer points. */
function software() {
  const context = document.createElement('canvas').getContext('webgl2');
  if (!context) throw new Error('no WebGL 2');
  const name = context.getParameter(context.getExtension('WEBGL_debug_renderer_info')?.UNMASKED_RENDERER_WEBGL ?? context.RENDERER);
  context.getExtension('WEBGL_lose_context')?.loseContext();
  return /swiftshader|llvmpipe|software/i.test(String(name));
}
