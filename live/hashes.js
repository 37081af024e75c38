// The hash of the state beside that of the native program, which is known of each shipped scene at one step.

export class Hashes {
  #hash; #verdict; #native; #known = null; #done = false;

  constructor(hash, verdict, native) { [this.#hash, this.#verdict, this.#native] = [hash, verdict, native]; }

  /** known: the shipped scene {steps, hash} if it runs as it is, else null. */
  begin(known, state) {
    this.#known = known;
    this.#done = false;
    this.#hash.textContent = 'not yet';
    this.#verdict.textContent = '';
    this.#verdict.dataset.equal = '';
    this.#native.replaceChildren();
    if (known) {
      this.#native.textContent = `native program at step ${known.steps}: ${known.hash}`;
      this.step(0);
    } else if (state.text === null) {
      const link = Object.assign(document.createElement('a'), {href: `#scene=${encodeURIComponent(state.scene)}`, textContent: 'the scene without settings'});
      this.#native.append('The native hash is known of ', link, '. Of this one, the downloaded file run by the native program has the same at each step.');
    } else {
      this.#native.textContent = 'The native program reaches the same hashes with the downloaded file.';
    }
  }

  step(step) {
    if (this.#known && !this.#done) this.#verdict.textContent = step <= this.#known.steps ? `not yet: step ${step} of ${this.#known.steps}` : `not compared: step ${this.#known.steps} is over`;
  }

  take({step, hash}) {
    if (this.#done && step !== this.#known?.steps) return;
    this.#hash.textContent = `${hash} at step ${step}`;
    if (step !== this.#known?.steps) return;
    this.#done = true;
    const equal = hash === this.#known.hash;
    this.#verdict.textContent = equal ? 'equal to the native program’s' : 'NOT equal to the native program’s';
    this.#verdict.dataset.equal = equal ? 'yes' : 'no';
  }
}
