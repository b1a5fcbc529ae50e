// Describes a picture of the bake to whatever draws it.

import type { Rgb } from './data';
import { bounceMap, type Model } from './model';

export type Panel = 'off' | 'model' | 'bounce map' | 'truth' | 'bounce' | 'difference' | 'difference off';
export type View = Exclude<Panel, 'bounce map'> | 'compare';
export type PlainAo = 'ao' | 'visibility'; // α, or V

export interface Picture {
  model: Model;
  view: View;
  plain: PlainAo; // what `off` shades with
  albedo: Rgb;
  exposure: number; // powers of two
  asColor: boolean; // albedo times irradiance; else irradiance
  lastBounce: number; // of the truth; the one shown in view `bounce`
  range: number; // largest difference that has a colour of its own
  originX: number; // texel at the canvas' upper left corner
  originY: number;
  texelsPerPixel: number;
  dividers: number[]; // canvas pixels
}

// Lists the panels of view `compare` from left to right.
export const kCompared: Panel[] = bounceMap ? ['off', 'model', 'bounce map', 'truth'] : ['off', 'model', 'truth'];

// Returns the model that a panel shows.
export function modelOf(picture: Picture, panel: Panel): Model {
  return panel === 'bounce map' ? bounceMap! : picture.model;
}

// Returns the panel of each range of columns of the bake: first, and one after the last.
export function panelsOf(picture: Picture, width: number): [Panel, number, number][] {
  if (picture.view !== 'compare') return [[picture.view, 0, width]];
  const borders = picture.dividers.map((pixel) =>
    Math.min(Math.max(Math.round(picture.originX + pixel * picture.texelsPerPixel), 0), width));
  return kCompared.map((panel, i) => [panel, borders[i - 1] ?? 0, borders[i] ?? width]);
}

export interface Renderer {
  name: string;
  draw(picture: Picture): void;
}
