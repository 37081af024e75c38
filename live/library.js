/*
 * What a page needs of include/uncross.h, in JavaScript: the C library as WebAssembly, its handles, its errors.
 * Structs are read at the places that the header gives them, with pointers of 32 bits.
 */

/* enum uncross_code and enum uncross_cause. */
const CODES = ['ok', 'no memory', 'bad input', 'stopped', 'not written'];
const CAUSES = ['none', 'solvent move', 'solvent speed', 'vertex speed', 'solvent energy', 'vertex energy', 'cell mass',
                'vertex move', 'vertex place', 'bond too long', 'no memory', 'other'];
const ERROR_BYTES = 40 + 1024;

/* An error of the library, as struct uncross_error; of a scene's text also line and column, from 1. */
export class UncrossError extends Error {
  constructor(fields) {
    super(fields.message);
    Object.assign(this, fields);
    const place = /^[^\n]*?:(\d+):(\d+): /.exec(fields.message);
    if (place)
      [this.line, this.column] = [Number(place[1]), Number(place[2])];
  }
}

/* What the library asks of its surroundings. It prints a report only; there are no files. */
const NO_FILE = -44, NO_DESCRIPTOR = 8;
function imports(memory, printed) {
  const view = () => new DataView(memory().buffer);
  return {
    env: {emscripten_notify_memory_growth() {}, __syscall_faccessat: () => NO_FILE},
    wasi_snapshot_preview1: {
      proc_exit(code) { throw new Error(`the library ended with ${code}`); },
      fd_close: () => NO_DESCRIPTOR, fd_seek: () => NO_DESCRIPTOR,
      fd_write(descriptor, list, count, written) {
        let bytes = 0;
        for (let k = 0; k < count; k++) {
          const at = view().getUint32(list + 8 * k, true), length = view().getUint32(list + 8 * k + 4, true);
          printed.push(new Uint8Array(memory().buffer, at, length).slice());
          bytes += length;
        }
        view().setUint32(written, bytes, true);
        return 0;
      },
      environ_get: () => 0,
      environ_sizes_get(count, bytes) {
        view().setUint32(count, 0, true);
        view().setUint32(bytes, 0, true);
        return 0;
      },
    },
  };
}

/* Whether this engine has 128-bit vectors: a module of one function that makes one, and drops it. */
const VECTORS = new Uint8Array([0, 97, 115, 109, 1, 0, 0, 0, 1, 4, 1, 96, 0, 0, 3, 2, 1, 0, 10, 9, 1, 7, 0, 65, 0, 253, 15, 26, 11]);
export function hasVectors() {
  return WebAssembly.validate(VECTORS);
}

/* The library from the bytes, or a Response, of uncross.wasm or uncross-simd.wasm. */
export async function loadLibrary(source) {
  let memory;
  const printed = [], needs = imports(() => memory, printed);
  const made = source instanceof Response ? await WebAssembly.instantiate(await source.arrayBuffer(), needs)
                                          : await WebAssembly.instantiate(source, needs);
  memory = made.instance.exports.memory;
  made.instance.exports._initialize();
  return new Library(made.instance.exports, printed);
}

export class Library {
  constructor(c, printed) {
    this.c = c;
    this.printed = printed;
    this.version = this.text(c.uncross_version());
    this.error = c.malloc(ERROR_BYTES);
  }

  /* --- memory --------------------------------------------------------------------------------------------------- */

  get data() { return new DataView(this.c.memory.buffer); }
  u32(at) { return this.data.getUint32(at, true); }
  u64(at) { return this.data.getBigUint64(at, true); }
  f64(at) { return this.data.getFloat64(at, true); }

  text(at) {
    const bytes = new Uint8Array(this.c.memory.buffer);
    return new TextDecoder().decode(bytes.slice(at, bytes.indexOf(0, at)));
  }

  /* The text in the library's memory, to be freed there. */
  put(text) {
    const bytes = new TextEncoder().encode(text), at = this.c.malloc(bytes.length + 1);
    const memory = new Uint8Array(this.c.memory.buffer, at, bytes.length + 1);
    memory.set(bytes);
    memory[bytes.length] = 0;
    return at;
  }

  /* A copy of [count] doubles. */
  doubles(at, count) { return new Float64Array(this.c.memory.buffer, at, count).slice(); }
  integers(at, count) { return new Int32Array(this.c.memory.buffer, at, count).slice(); }

  /* What was printed since the last call. */
  takePrinted() {
    const decoder = new TextDecoder(), text = this.printed.map(bytes => decoder.decode(bytes, {stream: true})).join('');
    this.printed.length = 0;
    return text + decoder.decode();
  }

  /* Calls use(pointer) with so many bytes that are freed afterwards. */
  scratch(bytes, use) {
    const at = this.c.malloc(bytes + 1);
    if (at === 0)
      throw new UncrossError({code: 1, codeName: CODES[1], message: 'no memory in this page'});
    try {
      return use(at);
    } finally {
      this.c.free(at);
    }
  }

  failed() {
    const e = this.error, code = this.u32(e), cause = this.u32(e + 4);
    return new UncrossError({
      code, codeName: CODES[code], cause: CAUSES[cause], step: Number(this.u64(e + 8)),
      entity: Number(this.data.getBigInt64(e + 16, true)), value: this.f64(e + 24), limit: this.f64(e + 32),
      message: this.text(e + 40),
    });
  }

  /* The result of a function that returns a handle or a text; of one that returns a code. */
  must(pointer) {
    if (pointer === 0)
      throw this.failed();
    return pointer;
  }
  mustBeFine(code) {
    if (code !== 0)
      throw this.failed();
  }

  /* --- scenes --------------------------------------------------------------------------------------------------- */

  /* A scene from its text; settings: ["path=value", ...] that replace or add keys; seed: instead of the text's. */
  scene(name, text, settings = [], seed = undefined) {
    const c = this.c, all = [name, text, ...settings].map(t => this.put(t));
    try {
      const handle = this.scratch(4 * settings.length, list => {
        settings.forEach((_, k) => this.data.setUint32(list + 4 * k, all[2 + k], true));
        return this.must(c.uncross_scene_parse(all[0], all[1], list, settings.length, this.error));
      });
      const scene = new Scene(this, handle);
      if (seed !== undefined)
        this.mustBeFine(c.uncross_scene_set_seed(handle, BigInt(seed), this.error));
      return scene;
    } finally {
      all.forEach(at => c.free(at));
    }
  }
}

class Scene {
  constructor(library, handle) {
    this.library = library;
    this.handle = handle;
  }

  check() {
    this.library.mustBeFine(this.library.c.uncross_scene_check(this.handle, this.library.error));
  }

  /* The effective scene as YAML, every default filled in. */
  get text() {
    const l = this.library, at = l.must(l.c.uncross_scene_text(this.handle, l.error)), text = l.text(at);
    l.c.uncross_free(at);
    return text;
  }

  /* What `uncross check` prints of the scene. */
  get report() {
    this.library.mustBeFine(this.library.c.live_report(this.handle, this.library.error));
    return this.library.takePrinted();
  }

  /* The value of a key that holds one number, defaults included. */
  number(path) {
    const l = this.library, at = l.put(path);
    try {
      return l.scratch(8, to => {
        l.mustBeFine(l.c.uncross_scene_number(this.handle, at, to, l.error));
        return l.f64(to);
      });
    } finally {
      l.c.free(at);
    }
  }

  start() {
    const l = this.library;
    return new Simulation(l, l.must(l.c.uncross_sim_start(this.handle, l.error)));
  }

  free() {
    this.library.c.uncross_scene_free(this.handle);
    this.handle = 0;
  }
}

/* struct uncross_view with pointers of 32 bits. */
const VIEW = {particles: 16, vertices: 20, fibers: 24, kinds: 28, cells: 32, velocity: 76, mass: 80, next: 84, fiber: 88, first: 92, kind: 96};

class Simulation {
  constructor(library, handle) {
    this.library = library;
    this.handle = handle;
    const l = library, view = l.c.uncross_sim_view(handle), at = name => l.u32(view + VIEW[name]);
    this.particles = at('particles');
    this.vertices = at('vertices');
    this.fibers = at('fibers');
    this.cells = [...l.integers(view + VIEW.cells, 3)];
    this.next = l.integers(at('next'), this.vertices);
    this.first = l.integers(at('first'), this.fibers + 1);
    this.fiberOf = l.integers(at('fiber'), this.vertices);
    this.kindOf = l.integers(at('kind'), this.fibers);
    this.mass = l.doubles(at('mass'), this.vertices);
    this.kinds = Array.from({length: at('kinds')}, (_, k) => l.text(l.c.uncross_sim_kind(handle, k)));
  }

  free() {
    this.library.c.uncross_sim_free(this.handle);
    this.handle = 0;
  }

  advance(steps) {
    this.library.mustBeFine(this.library.c.uncross_sim_advance(this.handle, BigInt(steps), this.library.error));
  }

  /* The same; returns the bonds that met, two for each contact, named by their first vertices. */
  advanceAndSee(steps) {
    const l = this.library, room = 4096;
    return l.scratch(4 * (room + 1), at => {
      l.mustBeFine(l.c.live_advance(this.handle, steps, at + 4, room, at, l.error));
      return l.integers(at + 4, l.u32(at));
    });
  }

  get step() { return Number(this.library.c.uncross_sim_step(this.handle)); }
  get time() { return this.library.c.uncross_sim_time(this.handle); }

  /* The state hash as 16 hexadecimal digits, as in run.json. */
  get hash() {
    const l = this.library;
    return l.scratch(8, at => {
      l.mustBeFine(l.c.uncross_sim_hash(this.handle, at, l.error));
      return l.u64(at).toString(16).padStart(16, '0');
    });
  }

  get counts() {
    const l = this.library;
    return l.scratch(32, at => {
      l.mustBeFine(l.c.uncross_sim_counts(this.handle, at, l.error));
      const [moves, possible, executed, negative] = [0, 8, 16, 24].map(k => Number(l.u64(at + k)));
      return {moves, possible, executed, negative};
    });
  }

  /* Energies in kT, momentum in m a0/t0. */
  get conserved() {
    const l = this.library;
    return l.scratch(64, at => {
      l.mustBeFine(l.c.uncross_sim_conserved(this.handle, at, l.error));
      const [solvent, vertex, bond, bend, total, x, y, z] = l.doubles(at, 8);
      return {solvent, vertex, bond, bend, total, momentum: [x, y, z]};
    });
  }

  /* [vertices][3] a0, unwrapped. */
  get positions() {
    const l = this.library, bytes = 24 * this.vertices;
    return l.scratch(bytes, at => {
      l.mustBeFine(l.c.uncross_sim_positions(this.handle, at, l.error));
      return l.doubles(at, 3 * this.vertices);
    });
  }

  /* Place of the bead, a0, unwrapped; null if there is none. */
  get bead() {
    const l = this.library;
    return l.scratch(24, at => l.c.live_bead(this.handle, at) ? [...l.doubles(at, 3)] : null);
  }

  /* How far the image beyond y = L has slid along x, a0; 0 unless the box is sheared. */
  get offset() { return this.library.c.live_offset(this.handle); }

  /* [vertices][3] a0/t0, half a step ahead. */
  get velocities() {
    const l = this.library;
    return l.doubles(l.u32(l.c.uncross_sim_view(this.handle) + VIEW.velocity), 3 * this.vertices);
  }

  /* What a reader of the results should know: the limits of the paper that the scene leaves. */
  get warnings() {
    const l = this.library, at = l.must(l.c.live_warnings(this.handle, l.error)), text = l.text(at);
    l.c.uncross_free(at);
    return text.split('\n').filter(line => line !== '');
  }

  /* {position, velocity} of the solvent now, [particles][3] a0 and a0/t0, in the order of ids. */
  get solvent() {
    const l = this.library, count = 3 * this.particles;
    return l.scratch(16 * count, at => {
      l.mustBeFine(l.c.uncross_sim_solvent(this.handle, at, at + 8 * count, l.error));
      return {position: l.doubles(at, count), velocity: l.doubles(at + 8 * count, count)};
    });
  }

  /* [{name, columns: [names], rows, value: [rows][columns]}] of what the scene's `observe` asks for. */
  get tables() {
    const l = this.library;
    return l.scratch(8, at => {
      l.mustBeFine(l.c.uncross_sim_tables(this.handle, at, at + 4, l.error));
      return Array.from({length: l.u32(at + 4)}, (_, k) => this.table(l.u32(l.u32(at) + 4 * k)));
    });
  }

  table(at) {
    const l = this.library, columns = l.u32(at + 4), rows = l.u32(at + 8);
    return {
      name: l.text(l.u32(at)), rows, columns: Array.from({length: columns}, (_, k) => l.text(l.u32(l.u32(at + 12) + 4 * k))),
      value: rows ? l.doubles(l.u32(at + 16), rows * columns) : new Float64Array(0),
    };
  }
}
