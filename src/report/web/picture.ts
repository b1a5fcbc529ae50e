// Describes a picture of the bake to whatever draws it.

import type { Rgb } from './data';
import type { Model } from './model';

export type Panel = 'off' | 'model' | 'truth' | 'bounce' | 'difference' | 'difference off';
export type View = Panel | 'compare';

export interface Picture {
  model: Model;
  view: View;
  albedo: Rgb;
  exposure: number; // powers of two
  asColor: boolean; // albedo times irradiance; else irradiance
  lastBounce: number; // of the truth; the one shown in view `bounce`
  range: number; // largest difference that has a colour of its own
  originX: number; // texel at the canvas' upper left corner
  originY: number;
  texelsPerPixel: number;
  dividers: [number, number]; // canvas pixels
}

// Returns the panel of each range of columns of the bake: first, and one after the last.
export function panelsOf(picture: Picture, width: number): [Panel, number, number][] {
  if (picture.view !== 'compare') return [[picture.view, 0, width]];
  const [a, b] = picture.dividers.map((pixel) =>
    Math.min(Math.max(Math.round(picture.originX + pixel * picture.texelsPerPixel), 0), width));
  return [['off', 0, a], ['model', a, b], ['truth', b, width]];
}

export interface Renderer {
  name: string;
  draw(picture: Picture): void;
}
