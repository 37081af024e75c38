/* The library of uncross for Node and for browsers. library.js has scenes, simulations and errors. */
import {hasVectors, loadLibrary} from './library.js';
export * from './library.js';

/* Loads the build for this engine: with vectors of 128 bits where it has them, unless vectors is false. */
export async function load({vectors = hasVectors()} = {}) {
  const place = new URL(vectors ? './uncross-simd.wasm' : './uncross.wasm', import.meta.url);
  if (place.protocol !== 'file:')
    return loadLibrary(await fetch(place));
  const {readFile} = await import('node:fs/promises');
  return loadLibrary(await readFile(place));
}
