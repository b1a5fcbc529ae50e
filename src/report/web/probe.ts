// Shows one texel of the bake in numbers.

import { cssColor } from './color';
import type { Rgb } from './data';
import { bounceName, h } from './dom';
import { bounceMap } from './model';
import type { Picture } from './picture';
import { texelOf, truthOf, type Planes } from './planes';

export interface Probe {
  element: HTMLElement;
  show(x: number, y: number): void; // texel of the planes; outside nothing changes
  update(): void; // after another albedo or model
  texel(): [number, number];
}

const kRows = ['off', 'model', ...(bounceMap ? ['bounce map'] : []), 'truth', 'model − truth', ...(bounceMap ? ['map − truth'] : [])];

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

  const isError = (row: number) => kRows[row].endsWith('− truth');
  let barsOf = -1; // the texel of the bars
  const update = () => {
    const { albedo, model, plain, lastBounce } = picture();
    const texel = at[1] * planes.width + at[0];
    const inputs = texelOf(planes, texel);
    const light = (shade: (rho: number) => number) => albedo.map(shade) as Rgb;
    const off = light(() => inputs[plain]);
    const modelled = light((rho) => model.total(inputs, rho));
    const mapped = bounceMap && light((rho) => bounceMap!.total(inputs, rho));
    const traced = planes.irradiance.length > 0 ? light((rho) => truthOf(planes, texel, rho, lastBounce)) : null;
    const error = (of: Rgb) => traced && (of.map((value, c) => value - traced[c]) as Rgb);
    const rows = [off, modelled, ...(mapped ? [mapped] : []), traced, error(modelled), ...(mapped ? [error(mapped)] : [])];
    where.textContent = `texel ${at[0] * planes.stride}, ${at[1] * planes.stride}`;
    element.dataset.x = String(at[0] * planes.stride);
    element.dataset.y = String(at[1] * planes.stride);
    const irradiance = planes.irradiance.map((plane) => plane[texel] * planes.irradianceStep);
    facts.textContent = [`α ${inputs.ao.toFixed(4)}`]
      .concat(planes.visibility ? `V ${inputs.visibility.toFixed(4)}` : [])
      .concat(planes.irradiance.slice(1, 2).map(() => `E₁/π ${irradiance[1].toFixed(4)}`))
      .concat(bounceMap ? `E(${bounceMap.data.constants.bounce_albedo})/π ${inputs.bounce.toFixed(4)}` : [])
      .join('   ');
    rows.forEach((row, i) => {
      cells[i].forEach((cell, c) => (cell.textContent = row ? (isError(i) && row[c] >= 0 ? '+' : '') + row[c].toFixed(4).replace('-', '−') : '–'));
      swatches[i].style.background = row && !isError(i) ? cssColor(row.map((value, c) => value * albedo[c])) : 'transparent';
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
