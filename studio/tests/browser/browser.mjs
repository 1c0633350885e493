// A real Chromium with the built page in it.
import { mkdtemp, rm } from 'node:fs/promises';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { chromium } from 'playwright-core';
import { serve } from '../../serve.mjs';

const ARGUMENTS = ['--no-sandbox', '--disable-quic', '--no-first-run', '--disable-background-networking', '--disable-component-update',
  '--disable-sync', '--use-angle=swiftshader', '--enable-unsafe-swiftshader'];

/** Opens the page of `folder`. complaints: what the console said that it should not. */
export async function openStudio(folder, options = {}) {
  const { server, url } = await serve(folder);
  const profile = await mkdtemp(join(tmpdir(), 'studio-'));
  const context = await chromium.launchPersistentContext(profile, {
    executablePath: '/usr/bin/chromium', headless: true, args: ARGUMENTS, viewport: { width: 1280, height: 800 }, acceptDownloads: true, ...options,
  });
  const page = context.pages()[0] ?? (await context.newPage());
  const complaints = [];
  page.on('console', (message) => void (['error', 'warning'].includes(message.type()) && !/GPU stall|GL Driver/.test(message.text()) && complaints.push(message.text())));
  page.on('pageerror', (error) => complaints.push(error.message));
  const ready = async () => {
    await page.waitForFunction(() => document.documentElement.dataset.ready !== undefined);
  };
  await page.goto(url, { waitUntil: 'commit', timeout: 120_000 });
  page.setDefaultTimeout(60_000);
  await ready();
  const close = async () => {
    await context.close();
    server.close();
    await rm(profile, { recursive: true, force: true });
  };
  return { page, context, url, complaints, ready, close, server };
}

/** Waits until the engine has nothing to do. */
export async function idle(page) {
  await page.evaluate(() => globalThis.studio.app.idle());
}

export async function status(page) {
  return (await page.locator('[role=status]').textContent()) ?? '';
}
