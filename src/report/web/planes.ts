// Unpacks the planes of the bake (src/report/html_planes.cpp packs them).

import type { PlaneList } from './data';
import type { Texel } from './model';

export interface Planes {
  width: number;
  height: number;
  stride: number; // texel (x, y) here is (x·stride, y·stride) of the bake
  aoStep: number; // α = code · step
  irradianceStep: number; // E_b/π = code · step
  bounceStep: number; // E/π of the bounce map = code · step
  visibilityStep: number; // V = code · step, at most 1
  ao: Uint16Array | null;
  irradiance: Uint16Array[];
  bounce: Uint16Array | null;
  visibility: Uint16Array | null; // the plane of E₀ where there is one
}

// Unpacks one plane after another, so that the page stays alive. progress: takes the share done.
export async function readPlanes(list: PlaneList, progress: (share: number) => void): Promise<Planes> {
  const planes: Planes = {
    width: list.width,
    height: list.height,
    stride: list.stride,
    aoStep: 1,
    irradianceStep: 1,
    bounceStep: 1,
    visibilityStep: 1,
    ao: null,
    irradiance: [],
    bounce: null,
    visibility: null,
  };
  for (const [i, { name, step }] of list.list.entries()) {
    const element = document.querySelector(`script.plane[data-name="${name}"]`)!;
    const codes = unpredict(await inflate(bytesOf(element.textContent!)), list.width, list.height);
    element.remove();
    if (name === 'ao') {
      planes.ao = codes;
      planes.aoStep = step;
    } else if (name === 'bounce') {
      planes.bounce = codes;
      planes.bounceStep = step;
    } else if (name === 'visibility') {
      planes.visibility = codes;
      planes.visibilityStep = step;
    } else {
      planes.irradiance.push(codes);
      planes.irradianceStep = step / Math.PI;
    }
    progress((i + 1) / list.list.length);
  }
  if (planes.irradiance.length > 0) {
    planes.visibility = planes.irradiance[0];
    planes.visibilityStep = planes.irradianceStep;
  }
  return planes;
}

function bytesOf(base64: string): Uint8Array<ArrayBuffer> {
  const text = atob(base64);
  const bytes = new Uint8Array(text.length);
  for (let i = 0; i < text.length; ++i) bytes[i] = text.charCodeAt(i);
  return bytes;
}

async function inflate(bytes: Uint8Array<ArrayBuffer>): Promise<Uint8Array> {
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream('deflate'));
  return new Uint8Array(await new Response(stream).arrayBuffer());
}

// Low bytes, then high bytes, of folded differences from the median of left, above and left + above − corner.
function unpredict(bytes: Uint8Array, width: number, height: number): Uint16Array {
  const count = width * height;
  const codes = new Uint16Array(count);
  for (let y = 0, i = 0; y < height; ++y)
    for (let x = 0; x < width; ++x, ++i) {
      const left = x > 0 ? codes[i - 1] : 0;
      const above = y > 0 ? codes[i - width] : 0;
      const corner = x > 0 && y > 0 ? codes[i - width - 1] : 0;
      const low = left < above ? left : above;
      const high = left < above ? above : left;
      const plain = left + above - corner;
      const folded = bytes[i] | (bytes[count + i] << 8);
      const difference = (folded >> 1) ^ -(folded & 1);
      codes[i] = (plain < low ? low : plain > high ? high : plain) + difference;
    }
  return codes;
}

// Returns what models take of a texel.
export function texelOf(planes: Planes, texel: number): Texel {
  const value = (codes: Uint16Array | null, step: number) => (codes ? Math.min(codes[texel] * step, 1) : 0);
  return {
    ao: value(planes.ao, planes.aoStep),
    visibility: value(planes.visibility, planes.visibilityStep),
    bounce: value(planes.bounce, planes.bounceStep),
  };
}

// Returns ρᵇ E_b/π of one bounce.
export function bounceLight(planes: Planes, texel: number, albedo: number, bounce: number): number {
  return albedo ** bounce * planes.irradiance[bounce][texel] * planes.irradianceStep;
}

// Returns Σ ρᵇ E_b/π of the bounces up to `last`, which the reader chooses; a browser test holds it against the library.
export function truthOf(planes: Planes, texel: number, albedo: number, last: number): number {
  let sum = 0;
  for (let b = 0; b <= Math.min(last, planes.irradiance.length - 1); ++b) sum += bounceLight(planes, texel, albedo, b);
  return sum;
}
