// The hash of the state beside that of the native program, which is known of each shipped scene at one step.

export class Hashes {
  #hash; #verdict; #native; #progress; #known = null; #done = false;

  constructor(hash, verdict, native, progress) { [this.#hash, this.#verdict, this.#native, this.#progress] = [hash, verdict, native, progress]; }

  /** known: the shipped scene {steps, hash} if it runs as it is, else null. */
  begin(known, state) {
    this.#known = known;
    this.#done = false;
    this.#hash.textContent = 'not yet';
    this.#verdict.textContent = '';
    this.#verdict.dataset.equal = '';
    this.#native.replaceChildren();
    this.#progress.textContent = '';
    if (known) {
      this.#native.textContent = `The native program has ${known.hash} at step ${known.steps}.`;
      this.step(0);
    } else if (state.text === null) {
      const link = Object.assign(document.createElement('a'), {href: `#scene=${encodeURIComponent(state.scene)}`, textContent: 'the shipped scene'});
      this.#native.append('This state changes ', link, ', and only of that one a native hash is kept here. To compare this state, download its scene file and run it: the native program has the same hash at each step.');
    } else {
      this.#native.textContent = 'The native program reaches the same hashes with the downloaded file.';
    }
  }

  step(step) {
    if (this.#known && !this.#done) this.#progress.textContent = `Not yet: step ${Math.min(step, this.#known.steps)} of ${this.#known.steps}.`;
  }

  take({step, hash}) {
    if (this.#done && step !== this.#known?.steps) return;
    this.#hash.textContent = `${hash} at step ${step}`;
    if (step !== this.#known?.steps) return;
    this.#done = true;
    this.#progress.textContent = '';
    const equal = hash === this.#known.hash;
    this.#verdict.textContent = equal ? 'equal.' : 'NOT equal.';
    this.#verdict.dataset.equal = equal ? 'yes' : 'no';
  }
}
