// The text of the scene, with the numbers of its lines and a mark at the line that is wrong; files that come and go.

export class Editor {
  /** use(text): called with a text that somebody wants to run; it resolves to a refusal or null. */
  constructor(use) {
    const at = id => document.getElementById(id);
    [this.text, this.lines, this.error] = [at('text'), at('lines'), at('text-error')];
    this.use = use;
    this.text.addEventListener('input', () => this.#number());
    this.text.addEventListener('scroll', () => this.#scroll());
    at('use-text').addEventListener('click', () => this.#try());
    at('open').addEventListener('change', async event => {
      const [file] = event.target.files;
      event.target.value = '';
      if (file) this.#read(file);
    });
    this.#dropping();
  }

  show(text) {
    this.text.value = text;
    this.mark(null);
  }

  /** Shows a refusal, and its line. */
  mark(refusal) {
    this.wrong = refusal?.line || 0;
    this.error.hidden = !refusal;
    this.error.textContent = refusal?.message ?? '';
    if (this.wrong) this.text.setAttribute('aria-invalid', 'true');
    else this.text.removeAttribute('aria-invalid');
    this.#number();
    if (!this.wrong) return;
    const height = parseFloat(getComputedStyle(this.text).lineHeight);
    this.text.style.setProperty('--bad-top', `${8 + (this.wrong - 1) * height}px`);
    this.text.scrollTop = Math.max(0, (this.wrong - 6) * height);
  }

  #number() {
    const count = this.text.value.split('\n').length;
    this.lines.replaceChildren(...Array.from({length: count}, (_, line) => {
      const number = line + 1 === this.wrong ? document.createElement('b') : document.createElement('span');
      number.textContent = `${line + 1}\n`;
      return number;
    }));
    this.#scroll();
  }

  #scroll() { this.lines.scrollTop = this.text.scrollTop; }

  async #try() {
    const refusal = await this.use(this.text.value);
    this.mark(refusal);
    if (refusal) this.text.focus();
  }

  async #read(file) {
    this.text.value = await file.text();
    document.getElementById('tab-scene').click();
    this.#try();
  }

  #dropping() {
    const {body} = document, show = on => body.classList.toggle('dropping', on);
    addEventListener('dragover', event => { event.preventDefault(); show(true); });
    addEventListener('dragleave', event => { if (!event.relatedTarget) show(false); });
    addEventListener('drop', event => {
      event.preventDefault();
      show(false);
      const [file] = event.dataTransfer.files;
      if (file) this.#read(file);
    });
  }
}

/** Hands a text to the browser as a file. */
export function download(name, text) {
  const link = Object.assign(document.createElement('a'), {href: URL.createObjectURL(new Blob([text], {type: 'text/yaml'})), download: name});
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 1000);
}
