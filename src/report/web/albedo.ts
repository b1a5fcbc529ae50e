// Makes the controls of the albedo: presets, a slider for each channel, and a lock that keeps the channels equal.

import { cssColor } from './color';
import type { Rgb } from './data';
import { checkbox, h, slider } from './dom';

const kPresets: [string, Rgb][] = [
  ['brick', [0.62, 0.28, 0.2]],
  ['sand', [0.9, 0.6, 0.2]],
  ['grass', [0.25, 0.5, 0.15]],
  ['plaster', [0.8, 0.8, 0.78]],
  ['snow', [0.95, 0.95, 0.97]],
];

export function albedoControls(start: Rgb, change: (albedo: Rgb) => void): HTMLElement {
  const current: Rgb = [...start];
  let linked = false;
  const inputs: HTMLInputElement[] = [];
  const apply = (albedo: Rgb) => {
    inputs.forEach((input, c) => {
      current[c] = albedo[c];
      input.value = String(albedo[c]);
      input.nextElementSibling!.textContent = albedo[c].toFixed(2);
    });
    change([...albedo]);
  };
  const sliders = ['Red', 'Green', 'Blue'].map((name, c) => {
    const channel = name.toLowerCase();
    const element = slider({
      label: name, spoken: `${channel} albedo`, name: channel, range: [0, 1, 0.01], value: current[c], text: (value) => value.toFixed(2),
      change: (value) => {
        const albedo: Rgb = [...current];
        if (linked) albedo.fill(value);
        else albedo[c] = value;
        apply(albedo);
      },
    });
    inputs.push(element.querySelector('input')!);
    return element;
  });
  return h('fieldset', { class: 'albedo' },
    h('legend', {}, 'Albedo'),
    h('div', { class: 'presets' }, kPresets.map(([name, albedo]) =>
      h('button', { type: 'button', style: `--swatch:${cssColor(albedo)}`, onclick: () => apply(albedo) }, name))),
    sliders,
    checkbox('same in all channels', false, (checked) => {
      linked = checked;
      if (checked) apply([current[0], current[0], current[0]]);
    }));
}
