// Makes elements in few words.

type Child = Node | string | null | undefined | Child[];
type Attributes = Record<string, string | number | boolean | EventListener>;

// Attributes of true are set without a value, of false left out; functions become listeners of the name after "on".
export function h<Name extends keyof HTMLElementTagNameMap>(
  name: Name,
  attributes: Attributes = {},
  ...children: Child[]
): HTMLElementTagNameMap[Name] {
  const element = document.createElement(name);
  for (const [key, value] of Object.entries(attributes)) {
    if (typeof value === 'function') element.addEventListener(key.replace(/^on/, ''), value);
    else if (value !== false) element.setAttribute(key, value === true ? '' : String(value));
  }
  append(element, children);
  return element;
}

function append(parent: Node, children: Child[]): void {
  for (const child of children) {
    if (Array.isArray(child)) append(parent, child);
    else if (child !== null && child !== undefined)
      parent.appendChild(typeof child === 'string' ? document.createTextNode(child) : child);
  }
}

// Returns the content of a section of index.html.
export function place(id: string): HTMLElement {
  return document.querySelector(`#${id} .content`) as HTMLElement;
}

export function say(id: string, message: string): void {
  place(id).append(h('p', { class: 'missing' }, message));
}

export function table(head: string[], rows: (string | Node)[][], caption: string, firstNumber = 1): HTMLElement {
  const style = (column: number): Attributes => (column >= firstNumber ? { class: 'number' } : {});
  return h(
    'div',
    { class: 'scroll', tabindex: 0, role: 'region', 'aria-label': caption },
    h(
      'table',
      {},
      h('caption', {}, caption),
      h('thead', {}, h('tr', {}, head.map((cell, i) => h('th', { scope: 'col', ...style(i) }, cell)))),
      h(
        'tbody',
        {},
        rows.map((row) =>
          h('tr', {}, row.map((cell, i) => (i === 0 ? h('th', { scope: 'row' }, cell) : h('td', style(i), cell)))),
        ),
      ),
    ),
  );
}

// Writes a number with its exponent as people read it.
export function number(value: number | null | undefined, digits = 4): string {
  if (value === null || value === undefined || !Number.isFinite(value)) return '–';
  const size = Math.abs(value);
  const text =
    size !== 0 && (size < 1e-3 || size >= 1e6) ? value.toExponential(Math.min(digits, 2) - 1) : value.toPrecision(digits);
  return text.replace(/e([+-]\d+)/, (_, exponent) => `·10${superscript(Number(exponent))}`).replace('-', '−');
}

const kSuperscripts = '⁰¹²³⁴⁵⁶⁷⁸⁹';

function superscript(value: number): string {
  return String(value).replace(/\d/g, (digit) => kSuperscripts[Number(digit)]).replace('-', '⁻');
}

const kSubscripts = '₀₁₂₃₄₅₆₇₈₉';

// Writes E₁₂ for bounce 12.
export function bounceName(bounce: number, letter = 'E'): string {
  return letter + String(bounce).replace(/\d/g, (digit) => kSubscripts[Number(digit)]);
}

// Writes "0.2461 ± 0.0074".
export function withError(value: number, error: number | null): string {
  if (error === null || error === undefined) return number(value);
  const decimals = Math.min(Math.max(1 - Math.floor(Math.log10(error || 1)), 0), 8);
  return `${value.toFixed(decimals)} ± ${error.toFixed(decimals)}`.replace('-', '−');
}

let groups = 0;

// Makes radio buttons.
export function choice(
  label: string,
  options: [string, string][],
  chosen: string,
  change: (value: string) => void,
): HTMLElement {
  const name = `choice${groups++}`;
  return h(
    'fieldset',
    { class: 'choice' },
    h('legend', {}, label),
    options.map(([value, text]) =>
      h(
        'label',
        {},
        h('input', { type: 'radio', name, value, checked: value === chosen, onchange: () => change(value) }),
        h('span', {}, text),
      ),
    ),
  );
}

export function checkbox(label: string, checked: boolean, change: (checked: boolean) => void): HTMLElement {
  const input = h('input', { type: 'checkbox', checked, onchange: () => change(input.checked) });
  return h('label', { class: 'checkbox' }, input, h('span', {}, label));
}

export interface SliderOptions {
  label: string;
  spoken?: string; // its name for a screen reader; the label where there is none
  name: string; // of its input, and its class
  range: [number, number, number]; // lowest, highest, step
  value: number;
  text(value: number): string;
  change(value: number): void;
}

// Makes a slider with its value beside it.
export function slider({ label, spoken = label, name, range: [min, max, step], value, text, change }: SliderOptions): HTMLElement {
  const output = h('output', {}, text(value));
  const input = h('input', { type: 'range', min, max, step, value, name, 'aria-label': spoken });
  input.addEventListener('input', () => {
    output.textContent = text(Number(input.value));
    input.setAttribute('aria-valuetext', output.textContent);
    change(Number(input.value));
  });
  return h('label', { class: `slider ${name}` }, h('span', {}, label), input, output);
}
