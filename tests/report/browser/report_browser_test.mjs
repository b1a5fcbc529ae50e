// hemibake report in headless Chromium: the page opens from disk, draws, and shows what the C++ library says.
//   node report_browser_test.mjs HEMIBAKE PACKAGES
// PACKAGES: the build's folder page/, with node_modules. Exit code 77: skipped.

import assert from 'node:assert/strict';
import { existsSync, mkdtempSync, readFileSync, rmSync } from 'node:fs';
import { createRequire } from 'node:module';
import { tmpdir } from 'node:os';
import { dirname, join, resolve } from 'node:path';
import { after, before, test } from 'node:test';
import { fileURLToPath } from 'node:url';

import { kAlbedo, kOtherAlbedo, makeBakes, makeCurvePages, makeTables } from './bakes.mjs';
import { choose, encode, kChromium, launch, open, pixelOf, probeOf, setAlbedo, setSlider, settle, waitForPicture } from './page.mjs';

const [hemibake, packages] = process.argv.slice(2).map((path) => resolve(path));
if (!existsSync(kChromium)) {
  console.log(`skipped: there is no ${kChromium} (scripts/setup installs it)`);
  process.exit(77);
}

const kSize = [64, 48];
// Half a byte of rounding, and the difference of float and double under the curve of sRGB.
const kByte = 1.01;
const kPatience = 5000;  // ms
// Two units of the last of the four digits shown: their rounding, and the error of the codes.
const kDigits = 2e-4;

// Six digits of a plot, cut by the library.
const kPlotDigits = 5e-6;
// Rounding of doubles, and of 1 − F₀ near α = 1, which the page takes as a difference.
const kModelRounding = 1e-12;

const project = join(dirname(fileURLToPath(import.meta.url)), '../../..');
const folder = mkdtempSync(join(tmpdir(), 'hemibake-report-'));
let browser, bakes;

before(async () => {
  bakes = makeBakes(hemibake, folder, join(project, '.readme'));
  browser = await launch(packages);
});

after(async () => {
  await browser?.close();
  rmSync(folder, { recursive: true });
});

const fileOf = (name) => join(folder, name, 'report.html');

async function expectPixels(page, expected, light, albedo, exposure = 0) {
  for (const probe of expected.probes) {
    const wanted = [0, 1, 2].map((c) => encode(albedo[c] * light(probe)[c] * 2 ** exposure));
    const right = (pixel) => wanted.every((value, c) => Math.abs(pixel[c] - value) <= kByte);
    let pixel = await pixelOf(page, [probe.x, probe.y], kSize);
    // On a busy machine a new picture may take some frames.
    for (const end = Date.now() + kPatience; !right(pixel) && Date.now() < end; await settle(page))
      pixel = await pixelOf(page, [probe.x, probe.y], kSize);
    assert.ok(right(pixel), `texel ${probe.x},${probe.y}: ${pixel}, expected ${wanted}`);
  }
}

// Every view of the picture at one albedo.
async function expectViews(page, expected, albedo) {
  await choose(page, 'off');
  await expectPixels(page, expected, (probe) => [probe.ao, probe.ao, probe.ao], albedo);
  await choose(page, 'truth');
  await expectPixels(page, expected, (probe) => probe.truth, albedo);
  await choose(page, 'plain visibility');
  await choose(page, 'off');
  await expectPixels(page, expected, (probe) => [probe.visibility, probe.visibility, probe.visibility], albedo);
  await choose(page, 'plain ao');
  for (const model of ['bounce-map', 'visibility-ao', 'visibility', 'published', 'notes', 'bounded']) {
    await choose(page, model);
    await choose(page, 'model');
    await expectPixels(page, expected, (probe) => probe.models[model], albedo);
  }
}

async function expectProbes(page, expected) {
  for (const probe of expected.probes) {
    const shown = await probeOf(page, [probe.x, probe.y], kSize);
    assert.deepEqual([shown.x, shown.y], [probe.x, probe.y]);
    assert.ok(Math.abs(shown.ao - probe.ao) <= kDigits);
    for (let c = 0; c < 3; ++c) {
      assert.ok(Math.abs(shown.rows.off[c] - probe.ao) <= kDigits);
      const mapped = probe.models['bounce-map'][c];
      assert.ok(Math.abs(shown.rows['bounce map'][c] - mapped) <= kDigits, `bounce map ${shown.rows['bounce map'][c]}, expected ${mapped}`);
      assert.ok(Math.abs(shown.rows['map − truth'][c] - (mapped - probe.truth[c])) <= 2 * kDigits);
      assert.ok(Math.abs(shown.rows.model[c] - probe.models.bounded[c]) <= kDigits, `model ${shown.rows.model[c]}`);
      assert.ok(Math.abs(shown.rows.truth[c] - probe.truth[c]) <= kDigits, `truth ${shown.rows.truth[c]}`);
      assert.ok(Math.abs(shown.rows['model − truth'][c] - (probe.models.bounded[c] - probe.truth[c])) <= 2 * kDigits);
    }
  }
}

async function expectPlots(page, least) {
  const plots = page.locator('.plot');
  const count = await plots.count();
  assert.ok(count >= least, `${count} plots, expected ${least}`);
  for (let i = 0; i < count; ++i) {
    await plots.nth(i).scrollIntoViewIfNeeded();
    await page.waitForFunction((k) => document.querySelectorAll('.plot')[k].dataset.drawn === 'yes', i);
    const marks = await plots.nth(i).evaluate((plot) => {
      if (plot.tagName !== 'CANVAS') return plot.querySelectorAll('svg path').length;
      const data = plot.getContext('2d').getImageData(0, 0, plot.width, plot.height).data;
      return data.filter((value, k) => k % 4 === 3 && value > 0).length;
    });
    assert.ok(marks > 5, `plot ${i} has ${marks} marks`);
  }
}

for (const [hash, renderer] of [['', 'WebGL2'], ['#canvas', 'canvas']])
  test(`the picture is what the library says, by ${renderer}`, async () => {
    const page = await open(browser, fileOf('whole'), { hash });
    await waitForPicture(page);
    assert.equal(await page.getAttribute('.stage', 'data-renderer'), renderer);
    await expectViews(page, bakes.expected, kAlbedo);
    await expectProbes(page, bakes.expected);
    await setAlbedo(page, kOtherAlbedo);
    await expectViews(page, bakes.expectedOther, kOtherAlbedo);
    await expectProbes(page, bakes.expectedOther);

    await setSlider(page, 'exposure', 1.5);
    await expectPixels(page, bakes.expectedOther, (probe) => probe.models.bounded, kOtherAlbedo, 1.5);
    await setSlider(page, 'exposure', 0);

    // Truth of the first bounces only, and one bounce by itself.
    const sum = (probe, c, last) =>
      probe.irradiance.slice(0, last + 1).reduce((light, value, b) => light + value * kOtherAlbedo[c] ** b, 0);
    await choose(page, 'truth');
    await setSlider(page, 'bounces', 2);
    await expectPixels(page, bakes.expectedOther, (probe) => [0, 1, 2].map((c) => sum(probe, c, 2)), kOtherAlbedo);
    await choose(page, 'bounce');
    await expectPixels(page, bakes.expectedOther, (probe) => [0, 1, 2].map((c) => probe.irradiance[2] * kOtherAlbedo[c] ** 2), kOtherAlbedo);
    await setSlider(page, 'bounces', 20);

    // Blue where the model is too dark, red where it is too bright.
    await setSlider(page, 'range', 0.01);
    const luminance = [0.2126, 0.7152, 0.0722];
    for (const model of ['bounded', 'visibility', 'visibility-ao', 'bounce-map']) {
      await choose(page, model);
      await choose(page, 'difference');
      for (const probe of bakes.expectedOther.probes) {
        const difference = luminance.reduce((total, weight, c) => total + weight * kOtherAlbedo[c] * (probe.models[model][c] - probe.truth[c]), 0);
        if (Math.abs(difference) < 1e-3) continue;
        const [red, , blue] = await pixelOf(page, [probe.x, probe.y], kSize);
        assert.equal(red > blue, difference > 0, `${model}, texel ${probe.x},${probe.y}: ${difference}`);
      }
    }
    assert.deepEqual(page.complaints, []);
    await page.close();
  });

test('every bin of every stored curve is what the library says', async () => {
  const pages = makeCurvePages(hemibake, folder, join(project, 'fits/curves'));
  assert.ok(pages.length >= 4);
  for (const { name, bins, models } of pages) {
    const page = await open(browser, fileOf(name));
    const shown = await page.evaluate((tables) => {
      const { charts, models } = window.hemibake;
      const seriesOf = (label, series) => charts.find(({ element }) => element.ariaLabel.startsWith(label)).make().series
        .filter((each) => each.name.startsWith(series)).map((each) => each.data);
      const rowOf = (model, { ao }) => [ao, model.direct(ao), 1 - model.escape(ao), ...[0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10].map((r) => model.totalOf(ao, r / 10))];
      return {
        totals: seriesOf('All bounces together', 'data, ρ = '),
        sum: seriesOf('Sum of all bounces', 'sum of all bounces')[0],
        models: Object.fromEntries(Object.entries(tables).map(([id, rows]) =>
          [id, rows.map((row) => rowOf(models.find(({ data }) => data.id === id), row))])),
      };
    }, models);
    assert.equal(shown.totals.length, 11);
    const near = ([ao, value], bin, expected, what) =>
      assert.ok(Math.abs(ao - bin.ao) <= kPlotDigits && Math.abs(value - expected) <= kPlotDigits * Math.max(expected, 1e-3),
        `${name}, α = ${bin.ao}, ${what}: ${value}, expected ${expected} ± ${kPlotDigits} of it`);
    bins.forEach((bin, j) => {
      near(shown.sum[j], bin, bin.stored_bounces, 'stored bounces');
      shown.totals.forEach((points, r) => near(points[j], bin, bin.all_bounces[r], `albedo ${r / 10}`));
      // No tail brings more light than there is: the total exceeds π only where the stored bounces do.
      assert.ok(bin.all_bounces[10] <= Math.max(1, bin.stored_bounces) + kModelRounding);
    });
    for (const [id, rows] of Object.entries(models))
      rows.forEach((row, i) => {
        const expected = [row.ao, row.direct, row.bounce_ratio, ...Object.keys(row).filter((key) => key.startsWith('total')).map((key) => row[key])];
        shown.models[id][i].forEach((value, k) => assert.ok(Math.abs(value - expected[k]) <= kModelRounding,
          `${name}, ${id} at α = ${row.ao}, column ${k}: ${value}, expected ${expected[k]} ± ${kModelRounding}`));
      });
    assert.deepEqual(page.complaints, []);
    await page.close();
  }
});

test('models of V and the bounce map are what the library says', async () => {
  const page = await open(browser, fileOf('whole'));
  for (const [id, rows] of Object.entries(makeTables(hemibake, folder))) {
    assert.ok(rows.length > 100);
    const shown = await page.evaluate(([name, inputs]) => {
      const { total } = window.hemibake.models.find(({ data }) => data.id === name);
      return inputs.map((texel) => [0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10].map((r) => total(texel, r / 10)));
    }, [id, rows]);
    rows.forEach((row, i) => shown[i].forEach((value, r) => {
      const expected = row[`total_${(r / 10).toFixed(1)}`];
      assert.ok(Math.abs(value - expected) <= kModelRounding, `${id} at ${JSON.stringify(row)}, albedo ${r / 10}: ${value}`);
    }));
  }
  assert.deepEqual(page.complaints, []);
  await page.close();
});

test('comparison: each part shows its own light, and the borders move', async () => {
  const page = await open(browser, fileOf('whole'));
  await waitForPicture(page);
  const parts = (probe) => [[probe.ao, probe.ao, probe.ao], probe.models['visibility-ao'], probe.models['bounce-map'], probe.truth][Math.floor(probe.x / 16)];
  assert.deepEqual(new Set(bakes.expected.probes.map((probe) => probe.x)), new Set([8, 24, 40, 56]));
  await expectPixels(page, bakes.expected, parts, kAlbedo);
  const border = page.locator('.divider').first();
  await border.focus();
  await page.keyboard.press('Home');
  await settle(page);
  assert.equal(await border.getAttribute('aria-valuenow'), '0');
  await expectPixels(page, { probes: bakes.expected.probes.filter((probe) => probe.x === 8) }, (probe) => probe.models['visibility-ao'], kAlbedo);
  await page.locator('.divider').nth(1).focus();
  await page.keyboard.press('Home');
  await settle(page);
  const box = await page.locator('.stage canvas').boundingBox();
  const handle = await page.locator('.divider').nth(2).boundingBox();
  await page.mouse.move(handle.x + handle.width / 2, handle.y + 40);
  await page.mouse.down();
  await page.mouse.move(box.x + 0.05 * box.width, handle.y + 40, { steps: 3 });
  await page.mouse.up();
  await settle(page);
  await expectPixels(page, { probes: bakes.expected.probes }, (probe) => probe.truth, kAlbedo);
  assert.deepEqual(page.complaints, []);
  await page.close();
});

test('keys move the probe and zoom', async () => {
  const page = await open(browser, fileOf('whole'));
  await waitForPicture(page);
  const at = () => page.evaluate(() => [document.querySelector('.probe').dataset.x, document.querySelector('.probe').dataset.y].map(Number));
  await page.locator('.stage canvas').focus();
  const [x, y] = await at();
  await page.keyboard.press('ArrowRight');
  await page.keyboard.press('Shift+ArrowUp');
  assert.deepEqual(await at(), [x + 1, y - 16]);
  const zoom = () => page.locator('.toolbar .zoom').textContent();
  const whole = await zoom();
  await page.keyboard.press('+');
  await settle(page);
  assert.notEqual(await zoom(), whole);
  await page.keyboard.press('0');
  await settle(page);
  assert.equal(await zoom(), whole);
  assert.deepEqual(page.complaints, []);
  await page.close();
});

test('all plots are drawn, in light, dark and print', async () => {
  for (const colorScheme of ['light', 'dark']) {
    const page = await open(browser, fileOf('whole'), { colorScheme });
    await waitForPicture(page);
    // Bounces, sum, surface, direct light, albedos, tau, two of the sweep, the trade study.
    await expectPlots(page, 9);
    assert.equal(await page.locator('.missing').count(), 0);
    await page.locator('#pictures img').scrollIntoViewIfNeeded();
    await page.waitForFunction(() => document.querySelector('#pictures img').naturalWidth > 100);
    const pdf = await page.pdf();
    assert.ok(pdf.length > 50000, `${pdf.length} bytes of PDF`);
    assert.deepEqual(page.complaints, []);
    await page.close();
  }
});

test('chosen bounces and the chosen model are drawn again', async () => {
  const page = await open(browser, fileOf('whole'));
  await waitForPicture(page);
  const paths = () => page.locator('#curves .plot svg path').count();
  await page.locator('#curves .plot').scrollIntoViewIfNeeded();
  await page.waitForSelector('#curves .plot[data-drawn=yes]');
  const all = await paths();
  await page.getByRole('button', { name: 'first four' }).click();
  await settle(page);
  assert.ok((await paths()) < all / 2, `${await paths()} of ${all} paths`);
  const text = () => page.locator('#shader pre').textContent();
  assert.match(await text(), /visibility, float ao_uniform/);
  await choose(page, 'bounce-map');
  assert.match(await text(), /multi_bounce\(vec2 map/);
  await choose(page, 'notes');
  assert.match(await text(), /27\.5769/);
  assert.deepEqual(page.complaints, []);
  await page.close();
});

test('the shader text can be copied', async () => {
  const page = await open(browser, fileOf('whole'));
  await page.locator('#shader .copy').click();
  await page.waitForFunction(() => document.querySelector('.copied').textContent === 'copied');
  await page.close();
});

test('works at the width of a phone', async () => {
  const page = await open(browser, fileOf('whole'), { viewport: { width: 360, height: 740 }, hasTouch: true, isMobile: true, deviceScaleFactor: 2 });
  await waitForPicture(page);
  await expectPlots(page, 9);
  assert.ok((await page.evaluate(() => document.documentElement.scrollWidth)) <= 360);
  await choose(page, 'model');
  await expectPixels(page, bakes.expected, (probe) => probe.models['visibility-ao'], kAlbedo);
  assert.deepEqual(page.complaints, []);
  await page.close();
});

test('what is missing is said', async () => {
  for (const [name, words] of Object.entries(bakes.poor)) {
    const page = await open(browser, fileOf(name));
    if (!['only_curves', 'only_fit', 'only_check', 'only_light'].includes(name)) await waitForPicture(page);
    const said = (await page.locator('.missing').allTextContents()).join('\n');
    assert.ok(said.includes(words), `${name}: ${said}`);
    await expectPlots(page, 3);
    assert.deepEqual(page.complaints, [], name);
    await page.close();
  }
});

test('no barrier that axe knows of', async () => {
  const axe = readFileSync(createRequire(join(packages, 'package.json')).resolve('axe-core/axe.min.js'), 'utf8');
  for (const colorScheme of ['light', 'dark']) {
    const page = await open(browser, fileOf('whole'), { colorScheme });
    await waitForPicture(page);
    await page.evaluate(axe);
    const { violations } = await page.evaluate(() => window.axe.run({ runOnly: ['wcag2a', 'wcag2aa', 'wcag21a', 'wcag21aa'] }));
    assert.deepEqual(violations.map(({ id, nodes }) => [id, nodes.slice(0, 3).map((node) => node.html.slice(0, 120))]), []);
    await page.close();
  }
});
