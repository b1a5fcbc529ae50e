// Shows the model as text to paste, with a button that copies it.

import { report, type Language } from './data';
import { choice, h, place } from './dom';
import { currentModel, onModelChange, chooseModel } from './model';

const kLanguages: [Language, string][] = [['glsl', 'GLSL'], ['hlsl', 'HLSL'], ['cpp', 'C++']];

export function showShader(): void {
  let language: Language = 'glsl';
  const code = h('pre', { tabindex: 0, 'aria-label': 'shader text' });
  const copied = h('span', { role: 'status', class: 'copied' });
  const update = () => (code.textContent = currentModel().data.shader[language]);
  const copy = async () => {
    copied.textContent = (await copyText(code.textContent!)) ? 'copied' : 'could not copy: select the text below';
    setTimeout(() => (copied.textContent = ''), 4000);
  };
  update();
  onModelChange(update);
  place('shader').append(
    h('div', { class: 'options' },
      choice('Model', report.models.map((model) => [model.id, model.title]), currentModel().data.id, chooseModel),
      choice('Language', kLanguages, language, (value) => { language = value as Language; update(); }),
      h('button', { type: 'button', class: 'copy', onclick: () => void copy() }, 'Copy'), copied),
    code);
}

// Copies by the selection where a page opened from disk has no clipboard.
async function copyText(text: string): Promise<boolean> {
  try {
    await navigator.clipboard.writeText(text);
    return true;
  } catch {
    const area = h('textarea', { class: 'offscreen' });
    area.value = text;
    document.body.append(area);
    area.select();
    const done = document.execCommand('copy');
    area.remove();
    return done;
  }
}
