// Shows the numbers that a person quotes.

import { report, type BounceMapLoss } from './data';
import { h, number, place, table, withError } from './dom';

function percent(value: number | null | undefined): string {
  return value === null || value === undefined ? '–' : `${(100 * value).toFixed(2)} %`;
}

function card(name: string, value: string, detail = ''): HTMLElement {
  return h('div', { class: 'card' }, h('dt', {}, name), h('dd', {}, value), detail ? h('dd', { class: 'detail' }, detail) : null);
}

export function showSummary(): void {
  const { bake, curves, check, fits } = report;
  const cards: HTMLElement[] = [];
  if (bake) {
    if (bake.mean_ao !== null) cards.push(card('mean α', number(bake.mean_ao), 'uniform AO: visible share of the directions'));
    if (bake.mean_visibility !== null)
      cards.push(card('mean V', number(bake.mean_visibility), 'E₀/π, cosine-weighted: what GTAO, Substance and Unreal call AO'));
    if (bake.mean_irradiance.length > 1) cards.push(card('mean E₁/π', number(bake.mean_irradiance[1]), 'after one bounce, albedo 1'));
    if (bake.mean_total !== null)
      cards.push(card('energy', percent(bake.mean_total), `of π at albedo 1; still under way ${percent(bake.mean_residual)}, worst texel ${percent(bake.worst_residual)}`));
  }
  const best = report.models.find((model) => ['bounded', 'notes'].includes(model.id))!;
  if (best.score)
    cards.push(card('model of α', `${number(best.score.rms, 3)} rms`, `of E/π over α bins and albedos 0 … 1; ${best.title}`));
  if (check) {
    const judged = check.checks.filter((each) => each.tolerance !== null);
    const failed = judged.filter((each) => !each.passed).length;
    cards.push(card('checks', failed === 0 ? 'all pass' : `${failed} failed`, `${judged.length} judged`));
  }
  for (const [name, unit] of [['seconds', 's wall'], ['cpu_seconds', 's CPU']] as const) {
    const value = report.run?.[name];
    if (typeof value === 'number') cards.push(card(name === 'seconds' ? 'time' : 'processor', `${number(value, 3)} ${unit}`));
  }
  const host = place('summary');
  host.append(h('dl', { class: 'cards' }, cards));
  host.append(h('p', { class: 'note' }, sentence()));
  const missing = missingFiles();
  if (missing.length > 0)
    host.append(h('ul', { class: 'missing', 'aria-label': 'what is missing' }, missing.map((line) => h('li', {}, line))));
  if (fits) host.append(constants());
  if (curves || bake?.texel_errors.length) host.append(errors());
  if (bake?.bounce_map) host.append(bounceMapLoss(bake.bounce_map));
}

// Describes the bake in one sentence.
function sentence(): string {
  const s = report.bake?.settings;
  if (!s) return 'How the data were made is not known: there is no bake.exr here.';
  const rays = s.rays_traced !== undefined ? ` (${number(Number(s.rays_traced), 3)} rays)` : '';
  return (
    `${s.input}: ${report.bake!.width} × ${report.bake!.height} texels over ${s.size_m ?? '?'} m, amplitude ${s.amplitude_m ?? '?'} m, ` +
    `edges ${s.edge}, tracer ${s.tracer} with ${s.rays} ${s.tracer === 'slice' ? 'azimuths' : 'rays'} a texel${rays}, ` +
    `${s.bounces_made ?? s.bounces ?? 0} bounces between ${s.patches}; hemibake ${s.version}.`
  );
}

function missingFiles(): string[] {
  const { bake, curves, fits, check, run } = report;
  const lines: string[] = [];
  if (!bake) lines.push('No bake.exr: no picture and no settings.');
  else if (bake.mean_irradiance.length === 0) lines.push('The bake has no irradiance: no curves, no truth to compare with.');
  else if (!report.models.some(({ id }) => id === 'bounce-map'))
    lines.push('The bake has no bounce map (plane bounce, ‘hemibake bake --bounce-albedo’): that model is left out.');
  if (bake?.mean_irradiance.length === 1) lines.push('The bake has no bounces (--bounces 0): direct light only.');
  if (!curves) lines.push('No curves: made by ‘hemibake curves’ from a bake with ao and irradiance.');
  else if (curves.bins.filter((bin) => bin.count > 0).length < 2)
    lines.push('The curves have one bin with texels: a point each, and nothing to fit.');
  if (!fits) lines.push('No fit.json: the model of α shown is that of 2018 with its published constants, not fitted to this map.');
  if (!check) lines.push('No check.json: nothing says here that light is neither made nor lost.');
  if (!run) lines.push('No timings: ‘hemibake run --json’ prints them; saved as run.json in the folder they appear here.');
  return lines;
}

function constants(): HTMLElement {
  const rows = Object.entries(report.fits!)
    .filter(([name]) => name !== 'provenance')
    .map(([name, fit]) => [
      name,
      fit.formula,
      Object.entries(fit.parameters).map(([parameter, { value, stderr }]) =>
        `${parameter} = ${withError(value, stderr)}${stderr === null ? ' (on its bound)' : ''}`).join(',  '),
      number(fit.rms, 3),
      number(fit.max_error, 3),
      String(fit.points),
    ]);
  return table(['fit', 'formula (a = α)', 'constants ± standard error', 'rms', 'largest', 'points'], rows, 'Fitted constants; errors of E/π', 3);
}

function errors(): HTMLElement {
  const perTexel = report.bake?.texel_errors ?? [];
  const texelCells = (id: string) => perTexel.map((entry) => number(entry[id], 3));
  const rows = report.models.map((model) => [model.title, number(model.score?.rms, 3), number(model.score?.max, 3), ...texelCells(model.id)]);
  for (const other of report.other_models)
    rows.push([other.title, number(other.score?.rms, 3), number(other.score?.max, 3), ...texelCells(other.id)]);
  return table(['model', 'bins, rms', 'bins, largest', ...perTexel.map((entry) => `texels, ρ = ${entry.albedo}`)], rows,
               'How far each model is from this map, E/π: over bins × albedos 0, 0.1, … 1 (V is the mean of the bin), and rms over all texels at one albedo');
}

function bounceMapLoss({ bounce_albedo, truth_rms, albedos, stored }: BounceMapLoss): HTMLElement {
  const rows = stored.map(({ bits, box, rms, percentile, largest }) => [
    `${bits === 32 ? 'float' : `${bits} bits`}${box > 1 ? `, ${box} × ${box} box` : ''}`,
    ...albedos.map((_, i) => [rms, percentile, largest].map((list) => number(list[i], 2)).join(' · ')),
  ]);
  return table(['stored as', ...albedos.map((albedo) => `ρ = ${albedo}`)], rows,
               `What the bounce map of V and E at ρ = ${bounce_albedo} leaves of E/π: rms · 99.9th percentile · largest over the texels; ` +
               `the stored bounces tell the light to ${number(truth_rms, 2)} rms`);
}

export function showTitle(): void {
  document.getElementById('title')!.textContent = report.title;
  document.querySelector('footer')!.textContent = `Made by hemibake ${report.version}. Everything on this page is in this file.`;
}
