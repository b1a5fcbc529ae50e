// How fast a report is in headless Chromium with software GL: first paint, the picture, and frames a second while the
// albedo sliders move. Prints one JSON object.
//   node report_bench.mjs PACKAGES REPORT.html
// PACKAGES: the build's folder page/, with node_modules.

import { statSync } from 'node:fs';
import { resolve } from 'node:path';

import { choose, launch, open, waitForPicture } from '../report/browser/page.mjs';

const [packages, file] = process.argv.slice(2);
const kFrames = 60;

// Frames a second while a slider moves at every frame; each frame waits for the picture to be there.
async function framesPerSecond(page) {
  return page.evaluate(async (frames) => {
    const input = document.querySelector('.slider.green input');
    const canvas = document.querySelector('.stage canvas');
    const gl = document.querySelector('.stage').dataset.renderer === 'WebGL2' ? canvas.getContext('webgl2') : null;
    const frame = () => new Promise((done) => requestAnimationFrame(done));
    await frame();
    const start = performance.now();
    for (let i = 0; i < frames; ++i) {
      input.value = String((i % 50) / 50);
      input.dispatchEvent(new Event('input', { bubbles: true }));
      await frame();
      gl?.readPixels(0, 0, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, new Uint8Array(4));
    }
    return (1000 * frames) / (performance.now() - start);
  }, kFrames);
}

const browser = await launch(packages);
const result = { bytes: statSync(file).size };
for (const [name, hash] of [['webgl', ''], ['canvas', '#canvas']]) {
  const page = await open(browser, resolve(file), { hash });
  await waitForPicture(page);
  const paint = await page.evaluate(() => performance.getEntriesByName('first-contentful-paint')[0]?.startTime);
  const picture = await page.evaluate(() => performance.now());
  result[name] = { first_paint_ms: Math.round(paint), picture_ms: Math.round(picture) };
  for (const view of ['compare', 'truth', 'model']) {
    await choose(page, view);
    result[name][`${view}_frames_per_second`] = Number((await framesPerSecond(page)).toFixed(1));
  }
  await page.close();
}
await browser.close();
console.log(JSON.stringify(result, null, 2));
