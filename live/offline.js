// Keeps the page's files, so that it works without the net once it was loaded: kept.js answers from them where the net does not.

/** Fetches everything that the page has loaded once more, through the keeper. extra: what only the worker loads. */
export async function keep_files(extra) {
  if (!navigator.serviceWorker || !isSecureContext) return;
  try {
    await navigator.serviceWorker.register('./kept.js');
    await navigator.serviceWorker.ready;
    const loaded = performance.getEntriesByType('resource').map(entry => entry.name).filter(name => name.startsWith(location.origin));
    const wanted = [...new Set([location.href.replace(/#.*/, ''), ...loaded, ...extra.map(name => new URL(name, location.href).href)])];
    navigator.serviceWorker.controller ?? await new Promise(then => navigator.serviceWorker.addEventListener('controllerchange', then, {once: true}));
    await Promise.all(wanted.map(address => fetch(address).catch(() => null)));
  } catch { /* a browser that keeps nothing shows the page all the same */ }
}
