// Evaluates the models for plots, the probe and the picture without WebGL (formulas: src/model/closed_forms.h); a
// browser test holds them against the library. The picture's shader is the text that `hemibake export` writes.

import { report, type ModelData } from './data';

export interface Model {
  data: ModelData;
  direct(ao: number): number; // F₀
  escape(ao: number): number; // 1 − τ
  total(ao: number, albedo: number): number;
}

const kSmallestEscape = 1e-30;

function boundedDirect(c: Record<string, number>, ao: number): number {
  return ao * (1 + (1 - ao) * (c.k0 + (c.k1 - c.k0) * ao * ao));
}

function boundedEscape(c: Record<string, number>, ao: number): number {
  const direct = boundedDirect(c, ao);
  return c.q * (1 - (c.d * (1 - direct)) / (1 + 3 * direct));
}

export function mayaux2018Direct(c: Record<string, number>, ao: number): number {
  return ao * (1 + c.k * (1 - ao) ** c.e);
}

export function mayaux2018FirstBounce(c: Record<string, number>, ao: number): number {
  return c.A * ao * (1 - ao) ** 1.5 * Math.exp(-c.B * ao ** 0.25);
}

function guardedDirect(c: Record<string, number>, ao: number): number {
  return Math.min(Math.max(mayaux2018Direct(c, ao), 0), 1);
}

function guardedEscape(c: Record<string, number>, ao: number): number {
  const blocked = 1 - guardedDirect(c, ao);
  const first = mayaux2018FirstBounce(c, ao);
  return first < blocked ? Math.max(first / blocked, kSmallestEscape) : 1;
}

export function makeModel(data: ModelData): Model {
  const c = data.constants;
  const bounded = data.id === 'bounded';
  const direct = (ao: number) => (bounded ? boundedDirect(c, ao) : guardedDirect(c, ao));
  const escape = (ao: number) => (bounded ? boundedEscape(c, ao) : guardedEscape(c, ao));
  const total = (ao: number, albedo: number) => {
    const fromSky = direct(ao);
    const out = albedo * escape(ao);
    return out > 0 ? Math.min(fromSky + (1 - fromSky) * (out / (1 - albedo + out)), 1) : fromSky;
  };
  return { data, direct, escape, total };
}

// Returns F_b of a model: F₁ τ^(b−1) from the first bounce on.
export function bounceOf(model: Model, bounce: number, ao: number): number {
  if (bounce === 0) return model.direct(ao);
  const escape = model.escape(ao);
  return (1 - model.direct(ao)) * escape * (1 - escape) ** (bounce - 1);
}

export const models: Model[] = report.models.map(makeModel);

// Keeps the model that all plots and the picture show, and calls the listeners when another is chosen.
let current = models[0];
const listeners: (() => void)[] = [];

export function currentModel(): Model {
  return current;
}

export function chooseModel(id: string): void {
  current = models.find((model) => model.data.id === id) ?? current;
  listeners.forEach((listener) => listener());
}

export function onModelChange(listener: () => void): void {
  listeners.push(listener);
}
