// Shows the trade study: error against time of every tracer and estimator (src/trade/trade_file.h has the file's form).

import { axis, chart, grid, legend, line, tooltip, type Option } from './chart';
import { report } from './data';
import { choice, h, number, place, say, table } from './dom';
import { ramp, theme } from './theme';

interface TradeError {
  rmse: number;
  bias: number;
  max: number;
}

interface Run {
  id: string;
  method: string;
  settings: Record<string, string | number> | null; // null: of older versions
  representative: boolean;
  cpu_seconds: number;
  memory_bytes: number;
  error: Record<string, TradeError>;
  models?: Record<string, Record<string, TradeError>>;
}

interface Series {
  name: string;
  plane: string;
  slope: number | null;
  points: [number, number][];
}

interface Trade {
  effort?: string;
  series?: Series[];
  planes?: Record<string, string>;
  runs: Run[];
  fronts?: Record<string, { id: string; model: string; cpu_seconds: number; rmse: number }[]>;
}

export function showTrade(): void {
  const trade = report.trade as Trade | null;
  if (!trade || !Array.isArray(trade.runs))
    return say('trade', 'No trade study in the folder: ‘hemibake trade MAP -o DIR’ makes trade.json.');
  const names: Record<string, string> = { ao: 'AO α', direct: 'direct light E₀/π', first: 'first bounce E₁/π' };
  const planes = Object.keys(trade.fronts ?? { ao: 0, direct: 0 });
  let plane = planes[0];
  const plot = chart('Error against processor seconds of every tracer and estimator, with the best at each cost', 460, () => option(trade, plane));
  const convergence = trade.series?.length
    ? chart('Error against rays, azimuths or taps of every series of runs', 420, () => convergenceOption(trade.series!, plane))
    : null;
  place('trade').append(
    planes.length > 1
      ? choice('Error of', planes.map((name) => [name, names[name] ?? `all light, albedo ${Number(name.replace('light.', '')) / 100}`]), plane,
          (value) => { plane = value; plot.draw(); convergence?.draw(); })
      : '',
    plot.element,
    h('p', { class: 'note' }, 'Each mark is a run, the large ones those of the table; lower and farther left is better. The line is the best error to be had at each cost.'),
    ...(convergence
      ? [convergence.element, h('p', { class: 'note' }, 'Runs that differ in one setting only. A slope of −1 halves the error with twice the rays.')]
      : []),
    runs(trade, planes));
}

interface Spot {
  value: [number, number];
  run: Run;
  model: string;
}

function option(trade: Trade, plane: string): Option {
  const t = theme();
  const methods = [...new Set(trade.runs.map((run) => run.method))];
  const spots = (method: string): Spot[] =>
    trade.runs.filter((run) => run.method === method).flatMap((run) => {
      const found: Spot[] = [];
      if (run.error[plane]) found.push({ value: [run.cpu_seconds, run.error[plane].rmse], run, model: '' });
      const modelled = run.models?.bounded?.[plane];
      if (modelled) found.push({ value: [run.cpu_seconds, modelled.rmse], run, model: 'bounded model' });
      return found;
    });
  const series: Option[] = methods.map((method, i) => ({
    type: 'scatter', name: method, data: spots(method).filter((spot) => spot.value[0] > 0 && spot.value[1] > 0),
    color: ramp(methods.length > 1 ? i / (methods.length - 1) : 0),
    symbol: ['circle', 'rect', 'triangle', 'diamond'][i % 4],
    symbolSize: (_: unknown, { data }: { data: Spot }) => (data.run.representative ? 13 : 8),
  }));
  const paretoFront = trade.fronts?.[plane] ?? [];
  if (paretoFront.length > 0)
    series.push(line('best at each cost', paretoFront.map((each) => [each.cpu_seconds, each.rmse]), t.ink, { step: 'end', lineStyle: { width: 1.25, color: t.ink }, z: 1, tooltip: { show: false } }));
  return {
    // Their marks; one under another where there is room, else to be leafed through.
    legend: legend({ icon: undefined, itemHeight: 10, ...(innerWidth > 860 ? { type: 'plain' } : {}) }),
    grid: grid({ left: 84, top: innerWidth > 860 ? 92 : 44 }),
    tooltip: tooltip({
      trigger: 'item',
      formatter: ({ data }: { data?: Spot }) => (data?.run
        ? `<b>${data.run.method}</b> ${settings(data.run)}${data.model ? `<br>with the ${data.model}` : ''}<br>${number(data.value[0], 3)} CPU s, rms error ${number(data.value[1], 3)}`
        : ''),
    }),
    xAxis: axis('processor seconds', { type: 'log' }),
    yAxis: axis('rms error', { type: 'log', nameGap: 60 }),
    series,
  };
}

// Draws error against effort, a line per series, with the exponent of its power law in the legend.
function convergenceOption(all: Series[], plane: string): Option {
  const shown = all.filter((each) => each.plane === plane && each.points.length > 0);
  return {
    legend: legend({ icon: undefined, itemHeight: 10, ...(innerWidth > 860 ? { type: 'plain' } : {}) }),
    grid: grid({ left: 84, top: innerWidth > 860 ? 72 : 44 }),
    tooltip: tooltip({ trigger: 'item' }),
    xAxis: axis('rays, azimuths or taps per texel', { type: 'log' }),
    yAxis: axis('rms error', { type: 'log', nameGap: 60 }),
    series: shown.map((each, i) =>
      line(each.slope === null ? each.name : `${each.name}: slope ${each.slope.toFixed(2)}`, each.points,
        ramp(shown.length > 1 ? i / (shown.length - 1) : 0), { symbol: 'circle', symbolSize: 7, showSymbol: true })),
  };
}

function settings(run: Run): string {
  return Object.entries(run.settings ?? {}).map(([name, value]) => `${name} ${value}`).join(', ');
}

function runs(trade: Trade, planes: string[]): HTMLElement {
  const chosen = trade.runs.filter((run) => run.representative);
  return h('div', {}, table(
    ['method', 'settings', 'CPU s', 'MiB', ...planes.map((plane) => `${plane}: rms (bias)`)],
    (chosen.length > 0 ? chosen : trade.runs).map((run) => [
      run.method, settings(run), number(run.cpu_seconds, 3), (run.memory_bytes / 2 ** 20).toFixed(1),
      ...planes.map((plane) => {
        const error = run.error[plane] ?? run.models?.bounded?.[plane];
        return error ? `${number(error.rmse, 3)} (${number(error.bias, 2)})` : '–';
      }),
    ]),
    `Trade study${trade.effort ? `, effort ${trade.effort}` : ''}: one run of each method`, 2));
}
