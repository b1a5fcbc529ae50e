// Defines the colours of light on a screen, for the picture, its shader and the swatches.

import type { Rgb } from './data';

export const kLuminance: Rgb = [0.2126, 0.7152, 0.0722]; // of linear sRGB
export const kTooDark: Rgb = [0.13, 0.4, 0.67]; // ends of the scale of differences
export const kTooBright: Rgb = [0.7, 0.09, 0.17];

// Returns the sRGB value, 0..1, of linear light (IEC 61966-2-1); what is outside 0..1 is cut.
export function encode(light: number): number {
  const x = Math.min(Math.max(light, 0), 1);
  return x <= 0.0031308 ? x * 12.92 : 1.055 * x ** (1 / 2.4) - 0.055;
}

export function cssColor(light: number[]): string {
  return `rgb(${light.map((value) => Math.round(255 * encode(value))).join(',')})`;
}
