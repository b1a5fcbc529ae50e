// Evaluates the models for plots, the probe and the picture without WebGL (formulas: src/model/closed_forms.h); a
// browser test holds them against the library. The picture's shader is the text that `hemibake export` writes.

import { report, type ModelData } from './data';

// Holds what models take of a texel, each 0..1.
export interface Texel {
  ao: number; // α, uniform
  visibility: number; // V, cosine-weighted
  bounce: number; // E/π at the albedo of the bounce map; 0 where there is none
}

export interface Model {
  data: ModelData;
  total(texel: Texel, albedo: number): number; // E/π over all bounces
}

// Gives curves over α, which the plots show.
export interface ModelOfAo extends Model {
  direct(ao: number): number; // F₀
  blocked(ao: number): number; // 1 − F₀
  escape(ao: number): number; // 1 − τ
  totalOf(ao: number, albedo: number): number;
}

const kSmallestEscape = 1e-30;

function boundedDirect(c: Record<string, number>, ao: number): number {
  return ao * (1 + (1 - ao) * (c.k0 + (c.k1 - c.k0) * (ao * ao)));
}

function boundedBlocked(c: Record<string, number>, ao: number): number {
  const rest = 1 - ao;
  return rest * (rest + ao * (1 - c.k1 + (c.k1 - c.k0) * (rest * (1 + ao))));
}

function boundedEscape(c: Record<string, number>, ao: number): number {
  const direct = boundedDirect(c, ao), dark = c.q * (1 - c.d);
  return dark + (c.q - dark) * ((4 * direct) / (1 + 3 * direct));
}

export function mayaux2018Direct(c: Record<string, number>, ao: number): number {
  return ao * (1 + c.k * (1 - ao) ** c.e);
}

export function mayaux2018FirstBounce(c: Record<string, number>, ao: number): number {
  const rest = 1 - ao;
  return ao * rest * Math.sqrt(rest) * c.A * Math.exp(-c.B * Math.sqrt(Math.sqrt(ao)));
}

function guardedDirect(c: Record<string, number>, ao: number): number {
  return Math.min(Math.max(mayaux2018Direct(c, ao), 0), 1);
}

function guardedEscape(c: Record<string, number>, ao: number): number {
  const blocked = 1 - guardedDirect(c, ao);
  const first = mayaux2018FirstBounce(c, ao);
  return first < blocked ? Math.max(first / blocked, kSmallestEscape) : 1;
}

function totalFactor(direct: number, blocked: number, escape: number, albedo: number): number {
  const out = albedo * escape;
  return direct + blocked * (out / (1 - albedo + out));
}

function escapeIrradiance(visibility: number, escape: number, albedo: number): number {
  const kept = 1 - albedo;
  if (kept === 0) return 1; // also where no light escapes
  return 1 - (1 - visibility) * (kept / (kept + albedo * escape));
}

function bounceMapIrradiance(visibility: number, bounce: number, albedo: number, bounceAlbedo: number): number {
  if (albedo === 1) return 1;
  const blocked = 1 - visibility;
  const missing = Math.min(Math.max(1 - bounce, 0), blocked);
  const kept = (1 - albedo) * missing;
  const gained = albedo * ((1 - bounceAlbedo) / bounceAlbedo) * (blocked - missing);
  if (kept + gained === 0) return visibility; // E_r = 1 at ρ = 0, or V = 1
  return 1 - blocked * (kept / (kept + gained));
}

function makeModelOfAo(data: ModelData): ModelOfAo {
  const c = data.constants;
  const bounded = data.id === 'bounded';
  const direct = (ao: number) => (bounded ? boundedDirect(c, ao) : guardedDirect(c, ao));
  const blocked = (ao: number) => (bounded ? boundedBlocked(c, ao) : 1 - guardedDirect(c, ao));
  const escape = (ao: number) => (bounded ? boundedEscape(c, ao) : guardedEscape(c, ao));
  const totalOf = (ao: number, albedo: number) => Math.min(totalFactor(direct(ao), blocked(ao), escape(ao), albedo), 1);
  return { data, direct, blocked, escape, totalOf, total: ({ ao }, albedo) => totalOf(ao, albedo) };
}

function makeModel(data: ModelData): Model {
  const c = data.constants;
  const escape = (share: number) => c.dark + (c.open - c.dark) * share;
  switch (data.id) {
    case 'visibility':
      return { data, total: ({ visibility }, albedo) => escapeIrradiance(visibility, escape(visibility), albedo) };
    case 'visibility-ao':
      return { data, total: ({ visibility, ao }, albedo) => escapeIrradiance(visibility, escape(ao), albedo) };
    case 'bounce-map':
      return { data, total: ({ visibility, bounce }, albedo) => bounceMapIrradiance(visibility, bounce, albedo, c.bounce_albedo) };
    default:
      return makeModelOfAo(data);
  }
}

// Returns F_b of a model: F₁ τ^(b−1) from the first bounce on.
export function bounceOf(model: ModelOfAo, bounce: number, ao: number): number {
  if (bounce === 0) return model.direct(ao);
  const escape = model.escape(ao);
  return model.blocked(ao) * escape * (1 - escape) ** (bounce - 1);
}

export const models: Model[] = report.models.map(makeModel);
export const modelsOfAo = models.filter((model): model is ModelOfAo => 'direct' in model);
export const bounceMap = models.find((model) => model.data.id === 'bounce-map') ?? null;

// Keeps the model that the picture and the shader text show, and calls the listeners when another is chosen.
let current = models[0];
let currentOfAo = modelsOfAo[0];
const listeners: (() => void)[] = [];

export function currentModel(): Model {
  return current;
}

// Returns the model that the plots over α show: the last one chosen that is of α.
export function currentModelOfAo(): ModelOfAo {
  return currentOfAo;
}

export function chooseModel(id: string): void {
  current = models.find((model) => model.data.id === id) ?? current;
  currentOfAo = modelsOfAo.find((model) => model === current) ?? currentOfAo;
  listeners.forEach((listener) => listener());
}

export function onModelChange(listener: () => void): void {
  listeners.push(listener);
}
