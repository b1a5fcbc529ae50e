// Draws all bounces over AO with their spread, the model and its residuals, and the sum of the bounces.

import { aoAxis, axis, band, chart, curve, dashed, grid, line, tooltip, type Option, type Pair } from './chart';
import { pointsOf, report, type Point } from './data';
import { bounceName, checkbox, h, number, place, say, table } from './dom';
import { bounceOf, currentModelOfAo } from './model';
import { onThemeChange, ramp, theme } from './theme';

const kNoCurves = 'The folder has no curves: they need a bake with ao and irradiance.';

export function showCurves(): void {
  if (!report.curves) {
    say('curves', kNoCurves);
    return say('sum', kNoCurves);
  }
  const points = pointsOf(report.curves);
  showBounces(points, report.curves.bounces);
  showSum(points, report.curves.bounces);
}

function bounceColor(bounce: number, bounces: number): string {
  return ramp(bounces > 1 ? Math.sqrt(bounce / (bounces - 1)) : 0);
}

function showBounces(points: Point[], bounces: number): void {
  const shown = new Set(Array.from({ length: bounces }, (_, b) => b));
  const look: Look = { withSpread: report.curves!.has_counts, logarithmic: false };
  const draw = () => plot.draw();
  const plot = chart(
    `Irradiance over ambient occlusion, ${bounces} curves, with the model and its residuals`, 640,
    () => bouncesOption(points, bounces, shown, look));

  const chips = Array.from({ length: bounces }, (_, b) => {
    const chip = h('button', { type: 'button', 'aria-pressed': 'true', onclick: () => toggle([b], !shown.has(b)) }, bounceName(b));
    return chip;
  });
  const paint = () => chips.forEach((chip, b) => {
    chip.setAttribute('aria-pressed', String(shown.has(b)));
    chip.style.setProperty('--chip', bounceColor(b, bounces));
  });
  const toggle = (which: number[], on: boolean) => {
    for (const b of which) on ? shown.add(b) : shown.delete(b);
    paint();
    draw();
  };
  paint();
  onThemeChange(paint);
  const all = chips.map((_, b) => b);
  place('curves').append(
    h('div', { class: 'chips', role: 'group', 'aria-label': 'bounces shown' }, chips,
      h('button', { type: 'button', class: 'plain', onclick: () => toggle(all, true) }, 'all'),
      h('button', { type: 'button', class: 'plain', onclick: () => { toggle(all, false); toggle([0, 1, 2, 3].filter((b) => b < bounces), true); } }, 'first four')),
    h('div', { class: 'options' },
      report.curves!.has_counts ? checkbox('spread (± one standard deviation of the texels of a bin)', look.withSpread, (on) => { look.withSpread = on; draw(); }) : null,
      checkbox('logarithmic', false, (on) => { look.logarithmic = on; draw(); })),
    plot.element,
    numbers(points, bounces));
}

interface Look {
  withSpread: boolean;
  logarithmic: boolean;
}

function bouncesOption(points: Point[], bounces: number, shown: Set<number>, { withSpread, logarithmic }: Look): Option {
  const model = currentModelOfAo();
  const list = [...shown].sort((a, b) => a - b);
  // A logarithm has no zero.
  const keep = (value: number) => (logarithmic && value < 1e-5 ? null : value);
  const pairs = (value: (point: Point) => number): Pair[] => points.map((point) => [point.ao, value(point)]);
  const series: Option[] = [];
  const residual = { xAxisIndex: 1, yAxisIndex: 1 };
  for (const b of list) {
    const color = bounceColor(b, bounces);
    if (withSpread && points.length > 1) {
      const edge = (sign: number) => pairs((point) => Math.max(point.mean[b] + sign * point.spread[b], logarithmic ? 1e-5 : 0));
      series.push(band(`${bounceName(b)} spread`, edge(-1), edge(1), color, { z: 1 }));
    }
    series.push(line(bounceName(b), pairs((point) => point.mean[b]).map(([x, y]) => [x, keep(y!)]), color, { z: 3 }));
    series.push(dashed(`${bounceName(b)} model`, curve((ao) => bounceOf(model, b, ao)).map(([x, y]) => [x, keep(y!)]), color, { z: 4, tooltip: { show: false } }));
    series.push(line(`${bounceName(b)} data − model`, pairs((point) => point.mean[b] - bounceOf(model, b, point.ao)), color, { ...residual }));
  }
  series.push(line('', [[0, 0], [1, 0]], theme().faint, { ...residual, lineStyle: { width: 1, color: theme().faint }, showSymbol: false, silent: true, tooltip: { show: false } }));
  return {
    legend: { show: false },
    axisPointer: { link: [{ xAxisIndex: 'all' }] },
    tooltip: tooltip({ formatter: (at: { axisValue: number }[]) => describe(points, list, at[0]?.axisValue ?? 0) }),
    grid: [grid({ top: 14, bottom: 260 }), grid({ top: 440, bottom: 44 })],
    xAxis: [aoAxis({ gridIndex: 0, name: '' }), aoAxis({ gridIndex: 1 })],
    yAxis: [
      axis('E_b / π at albedo 1', { gridIndex: 0, nameGap: 42, min: logarithmic ? 1e-5 : 0, type: logarithmic ? 'log' : 'value' }),
      axis('data − model', { gridIndex: 1, nameGap: 42, splitNumber: 4 }),
    ],
    series,
  };
}

function describe(points: Point[], list: number[], ao: number): string {
  if (points.length === 0) return '';
  const point = points.reduce((best, each) => (Math.abs(each.ao - ao) < Math.abs(best.ao - ao) ? each : best));
  const rows = list.slice(0, 8).map((b) =>
    `<tr><th>${bounceName(b)}/π</th><td>${point.mean[b].toFixed(4)}</td><td>± ${point.spread[b].toFixed(4)}</td><td>model ${bounceOf(currentModelOfAo(), b, point.ao).toFixed(4)}</td></tr>`);
  return `<b>α ${point.ao.toFixed(3)}</b>, ${point.count} texels<table class="tip">${rows.join('')}</table>${list.length > 8 ? '…' : ''}`;
}

// Lists the numbers of the plot for people who cannot see it, made when asked for.
function numbers(points: Point[], bounces: number): HTMLElement {
  const details = h('details', {}, h('summary', {}, 'The numbers'));
  details.addEventListener('toggle', () => {
    if (details.childElementCount > 1) return;
    details.append(table(
      ['α', 'texels', ...Array.from({ length: bounces }, (_, b) => `${bounceName(b)}/π`)],
      points.map((point) => [point.ao.toFixed(3), String(point.count), ...point.mean.map((value) => number(value, 3))]),
      'Mean irradiance of each bounce by AO bin'));
  });
  return details;
}

function showSum(points: Point[], bounces: number): void {
  const plot = chart('Sum of all bounces at albedo 1 over ambient occlusion, and the line of pi', 380, () => {
    const t = theme();
    const layers: Option[] = [];
    for (let b = 0; b < bounces; ++b) {
      const color = bounceColor(b, bounces);
      layers.push(line(b === 0 ? 'E₀' : `+ ${bounceName(b)}`, points.map((point) => [point.ao, point.mean[b]]), color,
        { stack: 'sum', areaStyle: { color, opacity: points.length < 4 ? 0 : 0.55 }, lineStyle: { width: 0.6, color: t.card } }));
    }
    const sum = points.map((point): Pair => [point.ao, point.storedBounces]);
    return {
      legend: { show: false },
      tooltip: tooltip({ formatter: (at: { axisValue: number }[]) => {
        const ao = at[0]?.axisValue ?? 0;
        const nearest = sum.reduce((best, each) => (Math.abs(each[0] - ao) < Math.abs(best[0] - ao) ? each : best), sum[0]);
        return nearest ? `<b>α ${nearest[0].toFixed(3)}</b><br>Σ E_b/π ${nearest[1]!.toFixed(4)}` : '';
      } }),
      grid: grid({ top: 16 }),
      xAxis: aoAxis(),
      yAxis: axis('Σ E_b / π at albedo 1', { nameGap: 42, min: 0, max: (range: { max: number }) => Math.max(1.1, Math.ceil(10 * range.max) / 10) }),
      series: [
        ...layers,
        line('sum of all bounces', sum, t.ink, { lineStyle: { width: 2, color: t.ink }, z: 5 }),
        line('π', [[0, 1], [1, 1]], t.accent, { z: 6, showSymbol: false, lineStyle: { width: 1.5, type: [6, 4], color: t.accent },
          markLine: undefined, endLabel: { show: true, formatter: 'π', color: t.accent, fontWeight: 'bold', fontSize: 15, offset: [-16, -12] } }),
      ],
    };
  });
  const sums = points.map((point) => point.storedBounces);
  const worst = sums.reduce((far, sum, i) => (Math.abs(sum - 1) > Math.abs(sums[far] - 1) ? i : far), 0);
  place('sum').append(plot.element);
  if (points.length > 0)
    place('sum').append(h('p', { class: 'note' }, `Farthest from π: ${number(sums[worst])} π at α = ${points[worst].ao.toFixed(3)} (${points[worst].count} texels) after ${bounces - 1} bounces.`));
}
