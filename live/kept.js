// The keeper (a service worker): the net first, so that a new version is seen at once; what was kept where the net fails.
const name = 'uncross-live';

addEventListener('install', () => self.skipWaiting());
addEventListener('activate', event => event.waitUntil(self.clients.claim()));
addEventListener('fetch', event => {
  const {request} = event;
  if (request.method !== 'GET' || new URL(request.url).origin !== location.origin) return;
  event.respondWith((async () => {
    const kept = await caches.open(name);
    try {
      const answer = await fetch(request);
      if (answer.ok) await kept.put(request, answer.clone());
      return answer;
    } catch (error) {
      const old = await kept.match(request, {ignoreSearch: true});
      if (old) return old;
      throw error;
    }
  })());
});
