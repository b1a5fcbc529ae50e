// Shows the pictures that `hemibake render` wrote.

import { report } from './data';
import { h, place, say } from './dom';

export function showPictures(): void {
  if (report.pictures.length === 0)
    return say('pictures', 'No pictures in the folder: ‘hemibake render DIR/bake.exr -o DIR/pictures’ draws them.');
  const host = h('div', { class: 'gallery' });
  place('pictures').append(host);
  report.pictures.forEach(({ name, here }, i) => {
    if (!here) return;
    const title = name.replaceAll('_', ' ');
    const base64 = document.querySelector(`script.picture[data-index="${i}"]`)!.textContent!;
    host.append(h('figure', {}, h('img', { src: `data:image/png;base64,${base64}`, alt: title, loading: 'lazy', decoding: 'async' }), h('figcaption', {}, title)));
  });
  const left = report.pictures.filter(({ here }) => !here).map(({ name }) => name);
  if (left.length > 0) place('pictures').append(h('p', { class: 'note' }, `Not here, to keep the page small: ${left.join(', ')}.`));
}
