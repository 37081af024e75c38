// The worker that owns the C code, as events and promises. Its messages: worker.js.

/** @typedef {{message: string, line?: number, column?: number}} Refusal */

export class Engine extends EventTarget {
  #worker; #checks = new Map(); #number = 0;

  constructor() {
    super();
    this.#worker = new Worker(new URL('./worker.js', import.meta.url), {type: 'module'});
    this.#worker.addEventListener('message', ({data}) => this.#receive(data));
    this.#worker.addEventListener('error', event =>
      this.dispatchEvent(new CustomEvent('error', {detail: {message: `The worker has stopped: ${event.message || 'it could not be loaded'}`}})));
  }

  #receive(message) {
    const check = this.#checks.get(message.id);
    if (message.kind === 'checked') {
      this.#checks.delete(message.id);
      check?.(message);
    } else {
      this.dispatchEvent(new CustomEvent(message.kind, {detail: message}));
    }
  }

  /** Calls `then(detail)` at each message of a kind: ready, started, frame, tables, hash, error. */
  on(kind, then) { this.addEventListener(kind, event => then(event.detail)); }

  send(message) { this.#worker.postMessage(message); }

  /** A number that no message had before. */
  next() { return ++this.#number; }

  /** Reads and checks a scene without running it. @returns {Promise<{error: Refusal|null, text?: string, check?: string}>} */
  check(text, settings, seed) {
    const id = `check-${this.next()}`;
    return new Promise(resolve => {
      this.#checks.set(id, resolve);
      this.send({kind: 'check', id, text, settings, seed});
    });
  }
}
