// Draws the previews of the gallery with the page itself: node tests/browser/gallery.mjs PAGE-FOLDER; they are committed.
import { mkdirSync, writeFileSync } from 'node:fs';
import { openStudio, idle } from './browser.mjs';

const studio = await openStudio(process.argv[2], { viewport: { width: 712, height: 346 } });
const { page } = studio;
const folder = new URL('../../gallery/', import.meta.url).pathname;
mkdirSync(folder, { recursive: true });
const count = await page.locator('.card').count();
for (let i = 0; i < count; ++i) {
  const card = page.locator('.card').nth(i);
  const title = (await card.textContent()).trim();
  const opened = page.waitForResponse((answer) => /\.(obj|json)/.test(answer.url()));
  await card.click();
  await opened;
  await page.waitForFunction(() => globalThis.studio.app.work !== null);
  await idle(page);
  await page.evaluate(() => globalThis.studio.app.set('interpolate', { interpolate: true }));
  await page.waitForTimeout(700);
  await idle(page);
  const { name, picture } = await page.evaluate(async () => {
    const { app } = globalThis.studio;
    const cloud = app.work.faceOffsets.length < 2;
    app.stage.points.object.visible = cloud;
    app.stage.control.group.visible = app.problem !== '';
    app.stage.touch();
    await new Promise((resolve) => setTimeout(resolve, 300));
    const from = document.getElementById('canvas');
    const to = document.createElement('canvas');
    [to.width, to.height] = [320, 240];
    to.getContext('2d').drawImage(from, (from.width - from.height * 4 / 3) / 2, 0, (from.height * 4) / 3, from.height, 0, 0, 320, 240);
    return { name: app.work.source.name, picture: to.toDataURL('image/webp', 0.85) };
  });
  writeFileSync(`${folder}${name.replace(/\.(obj|json)$/, '.webp')}`, Buffer.from(picture.split(',')[1], 'base64'));
  process.stdout.write(`${title}: ${name}\n`);
  await page.evaluate(() => globalThis.studio.app.store.restore({ work: null, past: [], future: [] }));
  await page.waitForTimeout(300);
}
await studio.close();
