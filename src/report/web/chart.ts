// Draws plots by ECharts with this page's look: when they come near the window, before printing, and again when the
// theme or the model changes.

import { BarChart, CustomChart, LineChart, ScatterChart } from 'echarts/charts';
import { AriaComponent, GridComponent, LegendComponent, MarkLineComponent, TooltipComponent } from 'echarts/components';
import { init, use, type ECharts, type EChartsCoreOption } from 'echarts/core';
import { SVGRenderer } from 'echarts/renderers';

import { h } from './dom';
import { onModelChange } from './model';
import { onThemeChange, theme } from './theme';

use([
  AriaComponent, BarChart, CustomChart, GridComponent, LegendComponent, LineChart, MarkLineComponent, ScatterChart,
  SVGRenderer, TooltipComponent,
]);

export type Option = EChartsCoreOption;
export type Pair = [number, number | null];

export interface Chart {
  element: HTMLElement;
  draw(): void;
  make(): Option; // the option of ECharts as drawn now
}

export const charts: Chart[] = [];

// Makes a plot. label: for a screen reader. make: its option of ECharts without what all plots share.
export function chart(label: string, height: number, make: () => Option): Chart {
  const canvas = h('div', { class: 'plot', role: 'img', 'aria-label': label, style: `height:${height}px` });
  let plot: ECharts | null = null;
  const draw = () => {
    plot ??= init(canvas, null, { renderer: 'svg' });
    plot.resize();
    plot.setOption({ ...common(), ...make() }, { notMerge: true });
    canvas.dataset.drawn = 'yes';
  };
  const redraw = () => plot && draw();
  new IntersectionObserver(
    (entries, observer) => {
      if (!entries.some((entry) => entry.isIntersecting)) return;
      observer.disconnect();
      draw();
    },
    { rootMargin: '300px' },
  ).observe(canvas);
  let width = 0;
  new ResizeObserver(() => {
    if (canvas.clientWidth === width) return;
    width = canvas.clientWidth;
    redraw();
  }).observe(canvas);
  onThemeChange(redraw);
  onModelChange(redraw);
  const result = { element: canvas, draw, make };
  charts.push(result);
  return result;
}

addEventListener('beforeprint', () => charts.forEach((each) => each.draw()));

function common(): Option {
  const t = theme();
  return {
    animation: false,
    backgroundColor: 'transparent',
    textStyle: { fontFamily: 'system-ui, sans-serif', color: t.ink },
    grid: grid(),
    legend: legend(),
    tooltip: tooltip(),
  };
}

export function grid(more: Option = {}): Option {
  return { left: 62, right: 18, top: 44, bottom: 46, outerBoundsMode: 'none', ...more };
}

export function legend(more: Option = {}): Option {
  const t = theme();
  return { top: 4, type: 'scroll', textStyle: { color: t.ink }, pageTextStyle: { color: t.ink },
           pageIconColor: t.ink, inactiveColor: t.faint, icon: 'roundRect', itemWidth: 16, itemHeight: 4, ...more };
}

export function tooltip(more: Option = {}): Option {
  const t = theme();
  return { trigger: 'axis', confine: true, backgroundColor: t.card, borderColor: t.line, textStyle: { color: t.ink, fontSize: 12 },
           valueFormatter: (value: unknown) => (typeof value === 'number' ? value.toFixed(4) : '–'), ...more };
}

export function axis(name: string, more: Option = {}): Option {
  const t = theme();
  return {
    type: 'value',
    name,
    nameLocation: 'middle',
    nameGap: 28,
    nameTextStyle: { color: t.faint },
    axisLabel: { color: t.faint, hideOverlap: true },
    axisLine: { show: true, lineStyle: { color: t.line } },
    splitLine: { lineStyle: { color: t.line, opacity: 0.6 } },
    axisTick: { show: false },
    ...more,
  };
}

export function aoAxis(more: Option = {}): Option {
  return axis('ambient occlusion α', { min: 0, max: 1, axisPointer: { label: { precision: 3 } }, ...more });
}

export function line(name: string, data: Pair[], color: string, more: Option = {}): Option {
  return { type: 'line', name, data, color, lineStyle: { width: 1.75, color }, itemStyle: { color },
           showSymbol: data.length < 4, symbolSize: 7, symbol: 'circle', emphasis: { disabled: true }, ...more };
}

export function dashed(name: string, data: Pair[], color: string, more: Option = {}): Option {
  return line(name, data, color, { lineStyle: { width: 1.5, color, type: [5, 4] }, ...more });
}

// Fills the area between two curves over the same abscissas.
export function band(name: string, low: Pair[], high: Pair[], color: string, more: Option = {}): Option {
  return {
    type: 'custom',
    name,
    data: [[low.length > 0 ? low[0][0] : 0, 0]],
    silent: true,
    color,
    tooltip: { show: false },
    renderItem: (_: unknown, api: { coord(at: number[]): number[] }) => ({
      type: 'polygon',
      shape: {
        points: [...low, ...[...high].reverse()].map(([x, y]) => api.coord([x, y ?? 0])),
      },
      style: { fill: color, opacity: 0.16 },
    }),
    clip: true,
    ...more,
  };
}

// Abscissas α of a model's curve.
export const kAoSteps = Array.from({ length: 201 }, (_, i) => i / 200);

export function curve(evaluate: (ao: number) => number): Pair[] {
  return kAoSteps.map((ao) => [ao, evaluate(ao)]);
}
