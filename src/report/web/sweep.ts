// Shows the amplitude sweep, whose curves flatten at both ends.

import { aoAxis, axis, chart, grid, legend, line, type Option, type Pair } from './chart';
import { pointsOf, report } from './data';
import { h, number, place, say, table } from './dom';
import { ramp, theme } from './theme';

const kFewTexels = 20; // bins of fewer are noise

export function showSweep(): void {
  const sweep = report.sweep.map(({ amplitude_m, curves }) => {
    const points = pointsOf(curves);
    const count = points.reduce((sum, point) => sum + point.count, 0);
    const mean = (value: (index: number) => number) => points.reduce((sum, point, i) => sum + point.count * value(i), 0) / count;
    return {
      amplitude: amplitude_m,
      points,
      ao: mean((i) => points[i].ao),
      direct: mean((i) => points[i].mean[0]),
      first: curves.bounces > 1 ? mean((i) => points[i].mean[1]) : null,
      highest: curves.bounces > 1 ? Math.max(0, ...points.filter((point) => point.count >= kFewTexels).map((point) => point.mean[1])) : null,
    };
  });
  if (sweep.length === 0)
    return say('sweep', 'No amplitude sweep in the folder: ‘scripts/sweep MAP DIR/sweep’ bakes one; its AMPLITUDE.csv files are shown here.');

  const means = chart('Mean alpha, direct light and first bounce over the amplitude', 340, () => {
    const t = theme();
    const pairs = (value: (step: (typeof sweep)[number]) => number | null): Pair[] => sweep.map((step) => [step.amplitude, value(step)]);
    const dots: Option = { showSymbol: true, symbolSize: 7 };
    return {
      legend: legend(), grid: grid(),
      xAxis: axis('amplitude, m', { type: 'log' }), yAxis: axis('mean over the texels', { min: 0, max: 1, nameGap: 40 }),
      series: [
        line('α', pairs((step) => step.ao), t.second, dots), line('E₀/π', pairs((step) => step.direct), t.accent, dots),
        line('E₁/π', pairs((step) => step.first), t.third, dots), line('highest F₁', pairs((step) => step.highest), t.ink, dots),
      ],
    };
  });
  const curves = chart('First bounce over ambient occlusion, one curve for each amplitude', 340, () => ({
    legend: legend(), grid: grid(), xAxis: aoAxis(), yAxis: axis('E₁ / π at albedo 1', { min: 0, nameGap: 40 }),
    series: sweep.filter((step) => step.first !== null).map((step, i, { length }) =>
      line(`${step.amplitude} m`, step.points.filter((point) => point.count >= kFewTexels).map((point) => [point.ao, point.mean[1]]),
           ramp(length > 1 ? i / (length - 1) : 0))),
  }));
  place('sweep').append(
    h('div', { class: 'pair' }, means.element, curves.element),
    table(['amplitude, m', 'mean α', 'mean E₀/π', 'mean E₁/π', 'highest F₁'],
          sweep.map((step) => [String(step.amplitude), number(step.ao), number(step.direct), number(step.first), number(step.highest)]),
          'Amplitude sweep; α from the bins'));
}
