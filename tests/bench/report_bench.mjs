// How fast a report is in headless Chromium with software GL: first paint, the picture, and frames a second while the
// albedo sliders move. Beside the wall times, which other work on the machine stretches, the processor time of all the
// browser's processes. Prints one JSON object.
//   node report_bench.mjs PACKAGES REPORT.html
// PACKAGES: the build's folder page/, with node_modules.

import { readdirSync, readFileSync, statSync } from 'node:fs';
import { resolve } from 'node:path';

import { choose, launch, open, waitForPicture } from '../report/browser/page.mjs';

const [packages, file] = process.argv.slice(2);
const kFrames = 60;
const kTicksPerMillisecond = 0.1;

// Of all processes below this one, ms.
function browserTime() {
  const parents = new Map(), times = new Map();
  for (const id of readdirSync('/proc').filter((name) => /^\d+$/.test(name))) {
    try {
      const fields = readFileSync(`/proc/${id}/stat`, 'utf8').replace(/^.*\) /, '').split(' ');
      parents.set(Number(id), Number(fields[1]));
      times.set(Number(id), (Number(fields[11]) + Number(fields[12])) / kTicksPerMillisecond);
    } catch {
      // It ended in between.
    }
  }
  const isBelow = (id) => id > 1 && (parents.get(id) === process.pid || isBelow(parents.get(id) ?? 0));
  return [...times].filter(([id]) => isBelow(id)).reduce((sum, [, time]) => sum + time, 0);
}

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

const result = { bytes: statSync(file).size };
for (const [name, hash] of [['webgl', ''], ['canvas', '#canvas']]) {
  const browser = await launch(packages);
  // Chromium's own first steps are not the page's.
  await (await browser.newPage()).goto('about:blank');
  const before = browserTime();
  const page = await open(browser, resolve(file), { hash });
  await page.waitForFunction(() => performance.getEntriesByName('first-contentful-paint').length > 0);
  const paint = await page.evaluate(() => performance.getEntriesByName('first-contentful-paint')[0].startTime);
  await waitForPicture(page);
  const picture = await page.evaluate(() => performance.now());
  result[name] = {
    first_paint_ms: Math.round(paint),
    picture_ms: Math.round(picture),
    picture_cpu_ms: Math.round(browserTime() - before),
  };
  for (const view of ['compare', 'truth', 'model']) {
    await choose(page, view);
    const start = browserTime();
    const rate = await framesPerSecond(page);
    result[name][view] = {
      frames_per_second: Number(rate.toFixed(1)),
      cpu_ms_per_frame: Number(((browserTime() - start) / kFrames).toFixed(1)),
    };
  }
  await browser.close();
}
console.log(JSON.stringify(result, null, 2));
