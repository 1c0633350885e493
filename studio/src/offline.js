// Keeps all files of one build, and forgets those of builds before. VERSION and FILES come from vite.config.ts.
self.addEventListener('install', (event) => {
  event.waitUntil(caches.open(VERSION).then((cache) => cache.addAll(FILES)).then(() => self.skipWaiting()));
});
self.addEventListener('activate', (event) => {
  const others = (names) => names.filter((name) => name !== VERSION);
  event.waitUntil(caches.keys().then((names) => Promise.all(others(names).map((name) => caches.delete(name)))).then(() => self.clients.claim()));
});
self.addEventListener('fetch', (event) => {
  if (event.request.method !== 'GET') return;
  // The page itself from the network where there is one, so that a new build is seen; what it names has a hash.
  const kept = () => caches.match(event.request, { ignoreSearch: true });
  const answer = event.request.mode === 'navigate'
    ? fetch(event.request).catch(() => caches.match('./'))
    : kept().then((found) => found ?? fetch(event.request));
  event.respondWith(answer);
});
