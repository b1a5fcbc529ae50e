// A page of hemibake report in a real browser: how it is opened, asked and worked.

import { createRequire } from 'node:module';
import { pathToFileURL } from 'node:url';
import { join, resolve } from 'node:path';

export const kChromium = '/usr/bin/chromium';

// packages: the folder with node_modules. Without a graphics card Chromium draws in software (SwiftShader).
export async function launch(packages) {
  const { chromium } = createRequire(join(resolve(packages), 'package.json'))('playwright-core');
  return chromium.launch({
    executablePath: kChromium,
    args: ['--no-sandbox', '--enable-unsafe-swiftshader'],
  });
}

// Opens a file from disk; `complaints` collects errors, warnings of ours and everything asked of a network.
export async function open(browser, file, options = {}) {
  const page = await browser.newPage({ viewport: { width: 1280, height: 900 }, ...options });
  page.complaints = [];
  page.on('console', (message) => {
    // Chromium's own remark about reading pixels back, which this test does.
    if (message.text().includes('GPU stall due to ReadPixels')) return;
    if (['error', 'warning'].includes(message.type())) page.complaints.push(message.text());
  });
  page.on('pageerror', (error) => page.complaints.push(String(error)));
  page.on('request', (request) => {
    if (!/^(file|data|blob):/.test(request.url())) page.complaints.push(`asked for ${request.url()}`);
  });
  await page.goto(pathToFileURL(file).href + (options.hash ?? ''));
  await page.waitForSelector('html[data-plots=ready]', { timeout: 60000 });
  return page;
}

export async function waitForPicture(page) {
  await page.waitForSelector('.stage canvas[data-ready=yes]', { timeout: 60000 });
  await settle(page);
}

// Two frames: the page has drawn what was asked of it.
export async function settle(page) {
  await page.evaluate(() => new Promise((resolve) => requestAnimationFrame(() => requestAnimationFrame(resolve))));
}

export async function setSlider(page, name, value) {
  await page.evaluate(([selector, text]) => {
    const input = document.querySelector(selector);
    input.value = text;
    input.dispatchEvent(new Event('input', { bubbles: true }));
  }, [`.slider.${name} input`, String(value)]);
  await settle(page);
}

export async function setAlbedo(page, albedo) {
  for (const [c, name] of ['red', 'green', 'blue'].entries()) await setSlider(page, name, albedo[c]);
}

export async function choose(page, value) {
  await page.evaluate((wanted) => document.querySelector(`.viewer input[type=radio][value="${wanted}"]`).click(), value);
  await settle(page);
}

// Bytes of the picture at the middle of a texel, while the whole bake is shown.
export async function pixelOf(page, texel, size) {
  return page.evaluate(([x, y, width, height]) => {
    const source = document.querySelector('.stage canvas');
    const copy = document.createElement('canvas');
    copy.width = source.width;
    copy.height = source.height;
    const context = copy.getContext('2d');
    context.drawImage(source, 0, 0);
    const at = [((x + 0.5) / width) * copy.width, ((y + 0.5) / height) * copy.height].map(Math.floor);
    return [...context.getImageData(at[0], at[1], 1, 1).data];
  }, [...texel, ...size]);
}

// What the probe says with the pointer on a texel: {x, y, rows: {off, model, truth, 'model − truth'}}.
export async function probeOf(page, texel, size) {
  const box = await page.locator('.stage canvas').boundingBox();
  await page.mouse.move(box.x + ((texel[0] + 0.5) / size[0]) * box.width, box.y + ((texel[1] + 0.5) / size[1]) * box.height);
  await settle(page);
  return page.evaluate(() => {
    const probe = document.querySelector('.probe');
    const rows = {};
    for (const row of probe.querySelectorAll('tr[data-row]'))
      rows[row.dataset.row] = [...row.querySelectorAll('td')].map((cell) => Number(cell.textContent.replace('−', '-')));
    const facts = probe.querySelector('.facts').textContent;
    return { x: Number(probe.dataset.x), y: Number(probe.dataset.y), ao: Number(/α ([\d.]+)/.exec(facts)[1]), rows };
  });
}

export function encode(light) {
  const x = Math.min(Math.max(light, 0), 1);
  return 255 * (x <= 0.0031308 ? 12.92 * x : 1.055 * x ** (1 / 2.4) - 0.055);
}
