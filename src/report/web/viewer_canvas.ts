// Draws the picture without WebGL: every texel of the bake by the processor, then scaled onto the canvas.

import { encode, kLuminance, kTooBright, kTooDark } from './color';
import { modelOf, panelsOf, type Panel, type Picture, type Renderer } from './picture';
import { bounceLight, texelOf, truthOf, type Planes } from './planes';

// sRGB bytes of 0..1 in steps of 1/4095.
const kEncoded = Uint8ClampedArray.from({ length: 4096 }, (_, i) => Math.round(255 * encode(i / 4095)));

export function makeCanvasRenderer(canvas: HTMLCanvasElement, planes: Planes): Renderer {
  const context = canvas.getContext('2d')!;
  const panels = new Map<Panel, { settings: string; image: HTMLCanvasElement }>();

  // Returns what the panel shows, computed again only where something in it changed.
  const imageOf = (panel: Panel, picture: Picture): HTMLCanvasElement => {
    const settings = JSON.stringify([
      picture.model.data.id, picture.plain, picture.albedo, picture.exposure, picture.asColor, picture.lastBounce, picture.range,
    ]);
    let entry = panels.get(panel);
    if (!entry) {
      const image = document.createElement('canvas');
      image.width = planes.width;
      image.height = planes.height;
      panels.set(panel, (entry = { settings: '', image }));
    }
    if (entry.settings !== settings) {
      paint(entry.image, planes, panel, picture);
      entry.settings = settings;
    }
    return entry.image;
  };

  return {
    name: 'canvas',
    draw(picture) {
      context.clearRect(0, 0, canvas.width, canvas.height);
      context.imageSmoothingEnabled = false;
      const scale = 1 / picture.texelsPerPixel;
      for (const [panel, first, last] of panelsOf(picture, planes.width)) {
        if (last <= first) continue;
        const from = (first - picture.originX) * scale, to = (last - picture.originX) * scale;
        context.save();
        context.beginPath();
        context.rect(from, 0, to - from, canvas.height);
        context.clip();
        context.drawImage(
          imageOf(panel, picture),
          -picture.originX * scale,
          -picture.originY * scale,
          planes.width * scale,
          planes.height * scale,
        );
        context.restore();
      }
    },
  };
}

function paint(image: HTMLCanvasElement, planes: Planes, panel: Panel, picture: Picture): void {
  const context = image.getContext('2d')!;
  const pixels = context.createImageData(image.width, image.height);
  const gain = 2 ** picture.exposure;
  for (let i = 0; i < image.width * image.height; ++i) {
    let difference = 0;
    for (let c = 0; c < 3; ++c) {
      const albedo = picture.albedo[c];
      const light = (picture.asColor ? albedo : 1) * lightOf(planes, i, panel, picture, albedo);
      difference += light * kLuminance[c];
      pixels.data[4 * i + c] = kEncoded[Math.round(Math.min(Math.max(light * gain, 0), 1) * 4095)];
    }
    if (panel === 'difference' || panel === 'difference off') paintDifference(pixels.data, i, difference / picture.range);
    pixels.data[4 * i + 3] = 255;
  }
  context.putImageData(pixels, 0, 0);
}

// Returns the light of a texel in one channel; of the differences, signed.
export function lightOf(planes: Planes, texel: number, panel: Panel, picture: Picture, albedo: number): number {
  switch (panel) {
    case 'off':
      return texelOf(planes, texel)[picture.plain];
    case 'model':
    case 'bounce map':
      return modelOf(picture, panel).total(texelOf(planes, texel), albedo);
    case 'truth':
      return truthOf(planes, texel, albedo, picture.lastBounce);
    case 'bounce':
      return bounceLight(planes, texel, albedo, picture.lastBounce);
    case 'difference':
      return lightOf(planes, texel, 'model', picture, albedo) - lightOf(planes, texel, 'truth', picture, albedo);
    case 'difference off':
      return lightOf(planes, texel, 'off', picture, albedo) - lightOf(planes, texel, 'truth', picture, albedo);
  }
}

function paintDifference(data: Uint8ClampedArray, texel: number, difference: number): void {
  const x = Math.min(Math.max(difference, -1), 1);
  const end = x < 0 ? kTooDark : kTooBright;
  const share = Math.abs(x) ** 0.8;
  for (let c = 0; c < 3; ++c) data[4 * texel + c] = 255 * (0.97 + (end[c] - 0.97) * share);
}
