// Shows the picture of the bake with its controls, borders, zoom and pan.

import { albedoControls } from './albedo';
import { report } from './data';
import { checkbox, choice, h, number, place, say, slider } from './dom';
import { chooseModel, currentModel, models, onModelChange } from './model';
import { kCompared, type Picture, type PlainAo, type Renderer, type View } from './picture';
import { readPlanes, type Planes } from './planes';
import { makeProbe, type Probe } from './probe';
import { makeCanvasRenderer } from './viewer_canvas';
import { makeGlRenderer } from './viewer_gl';

const kWindowShare = 0.82;
const kLeastSide = 240; // pixels
const kSmallestTexelsPerPixel = 1 / 64;
export async function showViewer(): Promise<void> {
  const bake = report.bake;
  if (!bake) return say('see', 'The folder has no bake.exr, so there is no picture.');
  if (!bake.planes.list.some((plane) => plane.name === 'ao'))
    return say('see', 'This bake has no AO (channel ao), which the picture and the model start from.');
  const host = place('see');
  const status = h('p', { class: 'loading', role: 'status' }, 'Unpacking the bake …');
  host.append(status);
  const planes = await readPlanes(bake.planes, (share) => {
    status.textContent = `Unpacking the bake … ${Math.round(100 * share)} %`;
  });
  status.remove();
  if (planes.irradiance.length === 0)
    say('see', 'This bake has no irradiance: truth and differences are left out.');
  new Viewer(host, planes);
}

class Viewer {
  private canvas = h('canvas', { tabindex: 0, role: 'application', 'aria-describedby': 'viewer-keys' });
  private readonly stage = h('div', { class: 'stage' }, this.canvas);
  private renderer: Renderer;
  private picture: Picture;
  private shares = kCompared.slice(1).map((_, i) => (i + 1) / kCompared.length); // of the dividers, of the canvas' width
  private handles: HTMLElement[] = [];
  private labels: HTMLElement[] = [];
  private probe: Probe;
  private readout = new Map<string, () => void>();
  private pending = false;
  private zoomedOut = 1; // texels per pixel at which the whole bake is seen

  constructor(host: HTMLElement, private readonly planes: Planes) {
    const bounces = planes.irradiance.length;
    this.picture = {
      model: currentModel(),
      view: bounces > 0 ? 'compare' : 'off',
      plain: 'ao',
      albedo: [...report.albedo],
      exposure: 0,
      asColor: true,
      lastBounce: Math.max(bounces - 1, 0),
      range: 0.1,
      originX: 0,
      originY: 0,
      texelsPerPixel: 1,
      dividers: [],
    };
    this.probe = makeProbe(planes, () => this.picture);
    this.addDividers();
    host.append(
      h('div', { class: 'viewer' },
        h('div', { class: 'view' }, this.stage, this.scaleBar(), this.toolbar()),
        h('div', { class: 'panel' }, this.controls(), this.probe.element)),
      this.notes(),
    );
    this.renderer = this.makeRenderer();
    this.stage.dataset.renderer = this.renderer.name;
    this.listen();
    this.fit();
    new ResizeObserver(() => this.fit()).observe(this.stage.parentElement!);
    onModelChange(() => {
      this.picture.model = currentModel();
      this.redraw();
    });
    this.canvas.dataset.ready = 'yes';
  }

  // #canvas behind the page's name asks for the picture without WebGL.
  private makeRenderer(): Renderer {
    if (location.hash !== '#canvas') {
      const renderer = makeGlRenderer(this.canvas, this.planes);
      if (renderer) return renderer;
      // A canvas that was asked for one kind of context never gives another.
      const fresh = this.canvas.cloneNode() as HTMLCanvasElement;
      this.canvas.replaceWith(fresh);
      this.canvas = fresh;
    }
    return makeCanvasRenderer(this.canvas, this.planes);
  }

  private redraw(): void {
    if (this.pending) return;
    this.pending = true;
    requestAnimationFrame(() => {
      this.pending = false;
      this.placeDividers();
      this.readout.forEach((update) => update());
      this.renderer.draw(this.picture);
      this.probe.update();
    });
  }

  private set(change: Partial<Picture>): void {
    Object.assign(this.picture, change);
    this.redraw();
  }

  // Sizes the canvas so that the whole bake is in the stage.
  private fit(): void {
    const { width, height } = this.planes;
    const room = (this.stage.parentElement as HTMLElement).clientWidth;
    if (room === 0) return;
    // As wide as there is room, but no higher than the window; a strip of a bake keeps some height.
    const cssWidth = Math.round(Math.max(Math.min(room, (kWindowShare * innerHeight * width) / height), Math.min(room, kLeastSide)));
    const cssHeight = Math.round(Math.max(Math.min((cssWidth * height) / width, kWindowShare * innerHeight), kLeastSide / 4));
    const density = Math.min(devicePixelRatio, 2);
    if (this.canvas.width === Math.round(cssWidth * density) && this.canvas.height === Math.round(cssHeight * density)) return;
    this.stage.style.width = `${cssWidth}px`;
    this.canvas.width = Math.round(cssWidth * density);
    this.canvas.height = Math.round(cssHeight * density);
    this.canvas.style.height = `${cssHeight}px`;
    this.zoomedOut = Math.max(width / this.canvas.width, height / this.canvas.height);
    this.reset();
  }

  private reset(): void {
    const { width, height } = this.planes;
    const texelsPerPixel = this.zoomedOut;
    this.set({
      texelsPerPixel,
      originX: (width - this.canvas.width * texelsPerPixel) / 2,
      originY: (height - this.canvas.height * texelsPerPixel) / 2,
    });
  }

  // Keeps the texel under canvas pixel (x, y) where it is.
  private zoom(factor: number, x = this.canvas.width / 2, y = this.canvas.height / 2): void {
    const old = this.picture.texelsPerPixel;
    const texelsPerPixel = Math.min(Math.max(old / factor, kSmallestTexelsPerPixel), this.zoomedOut);
    this.set({
      texelsPerPixel,
      originX: this.inside(this.picture.originX + x * (old - texelsPerPixel), this.planes.width, this.canvas.width, texelsPerPixel),
      originY: this.inside(this.picture.originY + y * (old - texelsPerPixel), this.planes.height, this.canvas.height, texelsPerPixel),
    });
  }

  private pan(dx: number, dy: number): void {
    const step = this.picture.texelsPerPixel;
    this.set({
      originX: this.inside(this.picture.originX - dx * step, this.planes.width, this.canvas.width, step),
      originY: this.inside(this.picture.originY - dy * step, this.planes.height, this.canvas.height, step),
    });
  }

  // The canvas never leaves the bake; a side that is smaller than the canvas stays in its middle.
  private inside(origin: number, texels: number, pixels: number, step: number): number {
    const room = texels - pixels * step;
    return room <= 0 ? room / 2 : Math.min(Math.max(origin, 0), room);
  }

  private pixelOf(event: PointerEvent | WheelEvent): [number, number] {
    const box = this.canvas.getBoundingClientRect();
    const density = this.canvas.width / box.width;
    return [(event.clientX - box.left) * density, (event.clientY - box.top) * density];
  }

  private probeAt(x: number, y: number): void {
    const { originX, originY, texelsPerPixel } = this.picture;
    this.probe.show(Math.floor(originX + x * texelsPerPixel), Math.floor(originY + y * texelsPerPixel));
    this.placeCross();
  }

  private listen(): void {
    const pointers = new Map<number, [number, number]>();
    const canvas = this.canvas;
    canvas.addEventListener('pointerdown', (event) => {
      canvas.setPointerCapture(event.pointerId);
      pointers.set(event.pointerId, this.pixelOf(event));
    });
    for (const end of ['pointerup', 'pointercancel'] as const)
      canvas.addEventListener(end, (event) => pointers.delete(event.pointerId));
    canvas.addEventListener('pointermove', (event) => {
      const at = this.pixelOf(event);
      const before = pointers.get(event.pointerId);
      if (before) {
        pointers.set(event.pointerId, at);
        const other = [...pointers].find(([id]) => id !== event.pointerId)?.[1];
        if (other) {
          const spread = (from: [number, number]) => Math.hypot(from[0] - other[0], from[1] - other[1]);
          this.zoom(spread(at) / Math.max(spread(before), 1), (at[0] + other[0]) / 2, (at[1] + other[1]) / 2);
        } else this.pan(at[0] - before[0], at[1] - before[1]);
      }
      this.probeAt(...at);
    });
    canvas.addEventListener('pointerdown', (event) => this.probeAt(...this.pixelOf(event)));
    canvas.addEventListener('wheel', (event) => {
      // A page can be scrolled past the picture: only with Ctrl, or once the picture has been chosen, is it a zoom.
      if (!event.ctrlKey && document.activeElement !== canvas) return;
      event.preventDefault();
      this.zoom(2 ** (-event.deltaY / 400), ...this.pixelOf(event));
    }, { passive: false });
    canvas.addEventListener('keydown', (event) => {
      const step = event.shiftKey ? 16 : 1;
      const actions: Record<string, () => void> = {
        ArrowLeft: () => this.moveProbe(-step, 0),
        ArrowRight: () => this.moveProbe(step, 0),
        ArrowUp: () => this.moveProbe(0, -step),
        ArrowDown: () => this.moveProbe(0, step),
        '+': () => this.zoom(1.25),
        '=': () => this.zoom(1.25),
        '-': () => this.zoom(0.8),
        '0': () => this.reset(),
      };
      if (!actions[event.key] || event.ctrlKey || event.metaKey) return;
      event.preventDefault();
      actions[event.key]();
    });
  }

  private moveProbe(dx: number, dy: number): void {
    const [x, y] = this.probe.texel();
    const { width, height } = this.planes;
    this.probe.show(Math.min(Math.max(x + dx, 0), width - 1), Math.min(Math.max(y + dy, 0), height - 1));
    this.placeCross();
  }

  private cross = h('div', { class: 'cross', 'aria-hidden': 'true' });

  private placeCross(): void {
    const { originX, originY, texelsPerPixel } = this.picture;
    const [x, y] = this.probe.texel();
    const place = (texel: number, origin: number, size: number) => (100 * (texel + 0.5 - origin)) / (texelsPerPixel * size);
    const left = place(x, originX, this.canvas.width), top = place(y, originY, this.canvas.height);
    this.cross.hidden = left < 0 || left > 100 || top < 0 || top > 100;
    this.cross.style.left = `${left}%`;
    this.cross.style.top = `${top}%`;
  }

  private addDividers(): void {
    this.labels = kCompared.map((name) => h('span', { class: 'tag', 'aria-hidden': 'true' }, name));
    this.handles = kCompared.slice(1).map((right, i) => {
      const handle = h('div', { class: 'divider', role: 'slider', tabindex: 0, 'aria-label': `border between ${kCompared[i]} and ${right}`,
                                'aria-valuemin': 0, 'aria-valuemax': 100 });
      const move = (share: number) => {
        this.shares[i] = Math.min(Math.max(share, this.shares[i - 1] ?? 0), this.shares[i + 1] ?? 1);
        this.redraw();
      };
      handle.addEventListener('pointerdown', (event) => {
        handle.setPointerCapture(event.pointerId);
        event.preventDefault();
        handle.focus();
      });
      handle.addEventListener('pointermove', (event) => {
        if (!handle.hasPointerCapture(event.pointerId)) return;
        const box = this.canvas.getBoundingClientRect();
        move((event.clientX - box.left) / box.width);
      });
      handle.addEventListener('keydown', (event) => {
        const to: Record<string, number> = { ArrowLeft: this.shares[i] - 0.02, ArrowRight: this.shares[i] + 0.02, Home: 0, End: 1 };
        if (!(event.key in to)) return;
        event.preventDefault();
        move(to[event.key]);
      });
      return handle;
    });
    this.stage.append(...this.handles, ...this.labels, this.cross);
  }

  private placeDividers(): void {
    const compare = this.picture.view === 'compare';
    this.picture.dividers = this.shares.map((share) => share * this.canvas.width);
    this.handles.forEach((handle, i) => {
      handle.hidden = !compare;
      handle.style.left = `${100 * this.shares[i]}%`;
      handle.setAttribute('aria-valuenow', String(Math.round(100 * this.shares[i])));
    });
    const edges = [0, ...this.shares, 1];
    this.labels.forEach((label, i) => {
      label.hidden = !compare || edges[i + 1] - edges[i] < 0.1;
      if (kCompared[i] === 'off') label.textContent = this.picture.plain === 'ao' ? 'off: α' : 'off: V';
      label.style.left = `${50 * (edges[i] + edges[i + 1])}%`;
    });
    this.placeCross();
    this.canvas.setAttribute('aria-label',
      `picture of the bake, showing ${compare ? `${kCompared.join(', ')} side by side` : this.picture.view}`);
  }

  private controls(): HTMLElement {
    const bounces = this.planes.irradiance.length;
    const views: [View, string][] = [
      ['compare', 'compare'], ['off', 'off (AO)'], ['model', 'model'], ['truth', 'truth'], ['bounce', 'one bounce'],
      ['difference', 'model − truth'], ['difference off', 'off − truth'],
    ];
    return h('div', { class: 'controls' },
      choice('Show', bounces > 0 ? views : views.filter(([view]) => view === 'off' || view === 'model'),
             this.picture.view, (view) => this.set({ view: view as View })),
      this.planes.visibility
        ? choice('AO of “off”', [['plain ao', 'α, uniform'], ['plain visibility', 'V, cosine-weighted']], 'plain ao',
                 (plain) => this.set({ plain: plain.replace('plain ', '') as PlainAo }))
        : null,
      choice('Model', models.map((model) => [model.data.id, model.data.title]), this.picture.model.data.id, chooseModel),
      albedoControls(this.picture.albedo, (albedo) => this.set({ albedo })),
      slider({ label: 'Exposure', name: 'exposure', range: [-3, 5, 0.05], value: 0,
               text: (value) => `${value < 0 ? '−' : '+'}${Math.abs(value).toFixed(2)} EV`, change: (exposure) => this.set({ exposure }) }),
      bounces > 1
        ? slider({ label: 'Bounces', name: 'bounces', range: [0, bounces - 1, 1], value: bounces - 1, text: (value) => `0 … ${value}`,
                   change: (lastBounce) => this.set({ lastBounce }) })
        : null,
      bounces > 0
        ? slider({ label: 'Difference', name: 'range', range: [0.01, 0.3, 0.01], value: this.picture.range,
                   text: (value) => `± ${value.toFixed(2)}`, change: (range) => this.set({ range }) })
        : null,
      checkbox('colour (albedo × light) instead of light alone', true, (asColor) => this.set({ asColor })),
    );
  }

  // Explains the colours of a difference.
  private scaleBar(): HTMLElement {
    const low = h('span'), high = h('span');
    const bar = h('div', { class: 'scale', role: 'img' }, low, h('span', { class: 'colors' }), high);
    this.readout.set('scale', () => {
      const shown = this.picture.view.startsWith('difference');
      bar.classList.toggle('hidden', !shown);
      low.textContent = `−${this.picture.range.toFixed(2)}: too dark`;
      high.textContent = `too bright: +${this.picture.range.toFixed(2)}`;
      bar.setAttribute('aria-label', `colours from −${this.picture.range} (blue) by white to +${this.picture.range} (red)`);
    });
    return bar;
  }

  private toolbar(): HTMLElement {
    const zoomText = h('output', { class: 'zoom' });
    this.readout.set('zoom', () => {
      zoomText.textContent = `${number(1 / this.picture.texelsPerPixel / Math.min(devicePixelRatio, 2), 3)} px a texel`;
    });
    const button = (text: string, label: string, onclick: () => void) =>
      h('button', { type: 'button', 'aria-label': label, title: label, onclick }, text);
    return h('div', { class: 'toolbar' },
      button('−', 'zoom out', () => this.zoom(0.8)),
      button('+', 'zoom in', () => this.zoom(1.25)),
      button('whole', 'show the whole bake', () => this.reset()),
      button('save PNG', 'save this picture as PNG', () => this.save()),
      zoomText,
      h('span', { class: 'hint', id: 'viewer-keys' },
        'Drag: pan. Ctrl + wheel or two fingers: zoom. Keys: arrows move the probe (Shift: by 16), + − 0 zoom.'));
  }

  private save(): void {
    this.canvas.toBlob((blob) => {
      if (!blob) return;
      const link = h('a', { href: URL.createObjectURL(blob), download: 'hemibake.png' });
      link.click();
      URL.revokeObjectURL(link.href);
    });
  }

  private notes(): HTMLElement {
    const planes = report.bake!.planes;
    const every = planes.stride === 1 ? 'Every texel of the bake is here' : `Every ${planes.stride}th texel of the bake (${report.bake!.width} × ${report.bake!.height}) in both directions is here`;
    const map = planes.list.some(({ name }) => name === 'bounce') ? `, the bounce map by ${number(planes.bounce_error, 2)}` : '';
    return h('p', { class: 'note' },
      'α is the uniform visible fraction: the share of the directions that reach the sky. V = E₀/π weights them by the cosine: the ',
      'sky-view factor, and what GTAO, Substance and Unreal call AO. Each model takes the one that its name says. ',
      `${every}. Sky: radiance 1 from everywhere. Truth: Σ ρᵇ E_b over the stored bounces; the slider ends it early. `,
      'Light and colour are linear and shown as sRGB; what is above 1 at the exposure chosen is shown as 1. Values travel as 16-bit ',
      `numbers: α is off by at most ${number(planes.ao_error, 2)}${map}, one E_b/π by ${number(planes.irradiance_error_over_pi, 2)}, their sum by `,
      `${number(planes.total_error_over_pi, 2)} (measured).`);
  }
}
