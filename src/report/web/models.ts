// Draws the models against the data: direct light, all bounces at each albedo, and the ratio of the bounces.

import { aoAxis, axis, band, chart, curve, dashed, grid, legend, line, type Option, type Pair } from './chart';
import { pointsOf, report, type Point } from './data';
import { h, number, place, say } from './dom';
import { currentModelOfAo, mayaux2018Direct, mayaux2018FirstBounce, modelsOfAo, type ModelOfAo } from './model';
import { ramp, theme } from './theme';

const kNoCurves = 'The folder has no curves to hold the models against; the models are shown alone.';

export function showModels(): void {
  const points = report.curves ? pointsOf(report.curves) : [];
  if (!report.curves) for (const id of ['direct', 'albedo', 'ratio']) say(id, kNoCurves);
  showDirect(points);
  showAlbedos(points);
  showRatio(points);
}

// Gives the chosen model the colour of ink.
function colorOf(model: ModelOfAo): string {
  const t = theme();
  return model === currentModelOfAo() ? t.ink : model.data.id === 'notes' ? t.faint : t.third;
}

function showDirect(points: Point[]): void {
  place('direct').append(chart('Direct light over ambient occlusion: data, models, plain AO and the bounds of what a surface can let in', 400, () => {
    const t = theme();
    const pairs = (value: (point: Point) => number): Pair[] => points.map((point) => [point.ao, value(point)]);
    const low = curve((ao) => ao * ao), high = curve((ao) => ao * (2 - ao));
    const series: Option[] = [
      band('possible', low, high, t.faint, { z: 0 }),
      dashed('plain AO', curve((ao) => ao), t.second, { z: 2 }),
    ];
    if (points.length > 1)
      series.push(band('spread', pairs((point) => point.mean[0] - point.spread[0]), pairs((point) => point.mean[0] + point.spread[0]), t.accent));
    if (points.length > 0) series.push(line('data E₀/π', pairs((point) => point.mean[0]), t.accent, { z: 4, lineStyle: { width: 2.5, color: t.accent } }));
    for (const model of modelsOfAo)
      series.push(line(`F₀, ${model.data.title}`, curve((ao) => model.direct(ao)), colorOf(model),
        { z: 5, lineStyle: { width: model === currentModelOfAo() ? 1.75 : 1.25, color: colorOf(model), type: model.data.id === 'notes' ? [2, 3] : 'solid' } }));
    return {
      legend: legend({ data: series.map((each) => each.name).filter((name) => name !== 'spread') }),
      xAxis: aoAxis(), yAxis: axis('E₀ / π', { min: 0, max: 1, nameGap: 40 }), series,
    };
  }).element);
}

function showAlbedos(points: Point[]): void {
  place('albedo').append(chart('All bounces together over ambient occlusion at albedos from 0 to 1 in steps of 0.1, data and model', 480, () => {
    const series: Option[] = [];
    for (const [step, albedo] of report.plot_albedos.entries()) {
      const color = ramp(1 - albedo);
      if (points.length > 0)
        series.push(line(`data, ρ = ${albedo.toFixed(1)}`, points.map((point) => [point.ao, point.allBounces[step]]), color,
          { lineStyle: { width: 1, color }, showSymbol: true, symbolSize: points.length < 4 ? 7 : 3, z: 2 }));
      series.push(line(`model, ρ = ${albedo.toFixed(1)}`, curve((ao) => currentModelOfAo().totalOf(ao, albedo)), color,
        { lineStyle: { width: 2.5, color }, z: 3 }));
    }
    return {
      legend: { show: false },
      grid: grid({ top: 16 }),
      tooltip: { show: false },
      xAxis: aoAxis(),
      yAxis: axis('E / π', { min: 0, max: 1.05, nameGap: 40 }),
      series,
    };
  }).element, h('div', { class: 'ramp', role: 'img', 'aria-label': 'colours from albedo 0 to albedo 1' },
    h('span', {}, 'ρ = 0'), h('span', { class: 'colors' }), h('span', {}, 'ρ = 1')));
}

// Returns the α below 1 where F₀ of the formula of 2018 is 1: the pole of its τ.
function poleOf(constants: Record<string, number>): number | null {
  const excess = (ao: number) => mayaux2018Direct(constants, ao) - 1;
  let high = 1 - 1e-9, low = 0.5;
  for (let ao = 0.999; ao > 0.5; ao -= 0.001)
    if (excess(ao) > 0) {
      high = ao;
      break;
    }
  if (excess(high) <= 0) return null;
  for (let i = 0; i < 60; ++i) {
    const middle = (low + high) / 2;
    if (excess(middle) > 0) high = middle;
    else low = middle;
  }
  return high;
}

function showRatio(points: Point[]): void {
  const notes = modelsOfAo.find((model) => model.data.id === 'notes')!.data.constants;
  const pole = poleOf(notes);
  const raw = (ao: number) => 1 - mayaux2018FirstBounce(notes, ao) / (1 - mayaux2018Direct(notes, ao));
  place('ratio').append(chart('Ratio tau of each bounce to the one before over ambient occlusion, with the pole of the published formula', 400, () => {
    const t = theme();
    const measured = points.filter((point) => point.mean.length > 2 && point.mean[1] > 1e-6 && point.mean[0] < 1);
    const series: Option[] = [];
    if (measured.length > 0) {
      series.push(line('data E₂/E₁', measured.map((point) => [point.ao, point.mean[2] / point.mean[1]]), t.accent, { lineStyle: { width: 2.5, color: t.accent } }));
      series.push(line('data 1 − E₁/(π − E₀)', measured.map((point) => [point.ao, 1 - point.mean[1] / (1 - point.mean[0])]), t.second));
    }
    for (const model of modelsOfAo)
      if (model.data.id !== 'notes')
        series.push(line(`τ, ${model.data.title}`, curve((ao) => 1 - model.escape(ao)), colorOf(model), { lineStyle: { width: 1.75, color: colorOf(model) } }));
    const fine = Array.from({ length: 2001 }, (_, i) => i / 2000);
    series.push(line('τ, 2018 as published', fine.map((ao): Pair => { const tau = raw(ao); return [ao, Math.abs(tau) < 3 ? tau : null]; }), t.faint,
      { lineStyle: { width: 1.5, color: t.faint, type: [2, 3] },
        markLine: pole === null ? undefined : { silent: true, symbol: 'none', lineStyle: { color: t.accent, type: [6, 4] },
          label: { formatter: `pole at ${pole.toFixed(4)}`, color: t.accent, position: 'insideEndTop', rotate: 90, offset: [0, 0] }, data: [{ xAxis: pole }] } }));
    return { legend: legend(), xAxis: aoAxis(), yAxis: axis('τ', { min: -1, max: 1.5, nameGap: 36 }), series };
  }).element);
  const refit = report.models.find((model) => model.id === 'published');
  const refitPole = refit ? poleOf(refit.constants) : null;
  place('ratio').append(h('p', { class: 'note' },
    `With the published constants F₀ exceeds 1 from α = ${pole === null ? '–' : number(pole, 6)} on, so τ = 1 − F₁/(1 − F₀) has a pole there. `,
    refit ? (refitPole === null ? 'The same formulas fitted to this map have none.' : `The same formulas fitted to this map have one at α = ${number(refitPole, 5)}.`) : ''));
}
