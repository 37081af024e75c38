// What the page shows, as a link: the name of a shipped scene or a text of one's own, settings on top, and the seed.

/** @typedef {{scene: string, text: string|null, settings: Map<string, string>, seed: string|null}} State */

const to_letters = bytes => btoa(Array.from(bytes, byte => String.fromCharCode(byte)).join('')).replaceAll('+', '-').replaceAll('/', '_').replaceAll('=', '');
const from_letters = text => Uint8Array.from(atob(text.replaceAll('-', '+').replaceAll('_', '/')), letter => letter.charCodeAt(0));

async function through(stream, bytes) {
  return new Uint8Array(await new Response(new Blob([bytes]).stream().pipeThrough(stream)).arrayBuffer());
}

/** The part of the address behind `#`. @param {State} state */
export async function write_link(state) {
  const link = new URLSearchParams();
  if (state.text === null) link.set('scene', state.scene);
  else link.set('text', to_letters(await through(new CompressionStream('deflate-raw'), new TextEncoder().encode(state.text))));
  for (const [path, value] of state.settings) link.append('set', `${path}=${value}`);
  if (state.seed !== null) link.set('seed', state.seed);
  return '#' + link.toString();
}

/** The state that a link says; `fallback` names the scene of a link that says none. @returns {Promise<State>} */
export async function read_link(hash, fallback) {
  const link = new URLSearchParams(hash.replace(/^#/, ''));
  const settings = new Map(link.getAll('set').filter(text => text.includes('=')).map(text => {
    const at = text.indexOf('=');
    return [text.slice(0, at), text.slice(at + 1)];
  }));
  const seed = /^[0-9]{1,20}$/.test(link.get('seed') ?? '') ? link.get('seed') : null;
  let text = null;
  if (link.has('text')) text = new TextDecoder().decode(await through(new DecompressionStream('deflate-raw'), from_letters(link.get('text'))));
  return {scene: link.get('scene') ?? (text === null ? fallback.scene : 'own'), text,
          settings: link.has('scene') || text !== null ? settings : new Map(fallback.settings), seed};
}

/** Settings as the library takes them. @param {State} state */
export const settings_of = state => [...state.settings].map(([path, value]) => `${path}=${value}`);
