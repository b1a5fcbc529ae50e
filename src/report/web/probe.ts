// Shows one texel of the bake in numbers.

import { cssColor } from './color';
import type { Rgb } from './data';
import { bounceName, h } from './dom';
import type { Picture } from './picture';
import { aoOf, truthOf, type Planes } from './planes';

export interface Probe {
  element: HTMLElement;
  show(x: number, y: number): void; // texel of the planes; outside nothing changes
  update(): void; // after another albedo or model
  texel(): [number, number];
}

const kRows = ['off', 'model', 'truth', 'model − truth'] as const;

export function makeProbe(planes: Planes, picture: () => Picture): Probe {
  let at: [number, number] = [Math.floor(planes.width / 2), Math.floor(planes.height / 2)];
  const where = h('span', { class: 'where' });
  const swatches = kRows.map(() => h('i', { class: 'swatch', 'aria-hidden': 'true' }));
  const cells = kRows.map(() => [0, 1, 2].map(() => h('td', { class: 'number' })));
  const facts = h('p', { class: 'facts' });
  const bars = h('div', { class: 'bars', role: 'img' });
  const element = h('section', { class: 'probe', 'aria-label': 'probe', 'aria-live': 'polite' },
    h('h3', {}, 'Probe ', where),
    facts,
    h('table', {},
      h('thead', {}, h('tr', {}, h('th', { scope: 'col' }, 'E/π'), ['R', 'G', 'B'].map((c) => h('th', { scope: 'col', class: 'number' }, c)))),
      h('tbody', {}, kRows.map((name, i) => h('tr', { 'data-row': name }, h('th', { scope: 'row' }, swatches[i], name), cells[i])))),
    bars);

  let barsOf = -1; // the texel of the bars
  const update = () => {
    const { albedo, model, lastBounce } = picture();
    const texel = at[1] * planes.width + at[0];
    const ao = aoOf(planes, texel);
    const off: Rgb = [ao, ao, ao];
    const modelled = albedo.map((rho) => model.total(Math.min(ao, 1), rho)) as Rgb;
    const traced = planes.irradiance.length > 0 ? (albedo.map((rho) => truthOf(planes, texel, rho, lastBounce)) as Rgb) : null;
    const rows = [off, modelled, traced, traced && (modelled.map((value, c) => value - traced[c]) as Rgb)];
    where.textContent = `texel ${at[0] * planes.stride}, ${at[1] * planes.stride}`;
    element.dataset.x = String(at[0] * planes.stride);
    element.dataset.y = String(at[1] * planes.stride);
    const irradiance = planes.irradiance.map((plane) => plane[texel] * planes.irradianceStep);
    facts.textContent = `α ${ao.toFixed(4)}` + irradiance.slice(0, 2).map((value, b) => `   ${bounceName(b)}/π ${value.toFixed(4)}`).join('');
    rows.forEach((row, i) => {
      cells[i].forEach((cell, c) => (cell.textContent = row ? (i === 3 && row[c] >= 0 ? '+' : '') + row[c].toFixed(4).replace('-', '−') : '–'));
      swatches[i].style.background = row && i < 3 ? cssColor(row.map((value, c) => value * albedo[c])) : 'transparent';
    });
    if (barsOf !== texel) drawBars(bars, irradiance);
    barsOf = texel;
  };
  update();
  return {
    element,
    update,
    texel: () => at,
    show(x, y) {
      if (x < 0 || y < 0 || x >= planes.width || y >= planes.height) return;
      at = [x, y];
      update();
    },
  };
}

// Draws the bounces of the texel side by side.
function drawBars(host: HTMLElement, irradiance: number[]): void {
  const largest = Math.max(...irradiance, 1e-9);
  while (host.children.length < irradiance.length) host.append(h('b'));
  irradiance.forEach((value, b) => {
    const bar = host.children[b] as HTMLElement;
    bar.style.height = `${(100 * value) / largest}%`;
    bar.title = `${bounceName(b)}/π ${value.toFixed(5)}`;
  });
  host.setAttribute('aria-label', irradiance.map((value, b) => `bounce ${b}: ${value.toFixed(4)}`).join(', '));
}
