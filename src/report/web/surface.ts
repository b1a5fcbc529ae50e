// Draws the surface bounce × AO × irradiance, turned by hand: quadrilaterals from far to near on a plain canvas, which
// needs no WebGL and prints.

import { pointsOf, report, type Point } from './data';
import { h, place, say } from './dom';
import { heightColor, onThemeChange, theme } from './theme';

const kHeight = 0.62; // of the box, of its sides
const kTilts: [number, number] = [0.08, 1.4]; // radians above the ground

interface Camera {
  turn: number;
  tilt: number;
  zoom: number;
}

type Projected = [number, number, number]; // canvas x, y, depth

export function showSurface(): void {
  if (!report.curves || report.curves.bounces < 2)
    return say('surface', 'A surface over the bounces needs curves of at least one bounce.');
  const points = pointsOf(report.curves);
  if (points.length < 2) return say('surface', 'A surface over AO needs at least two bins with texels.');

  const camera: Camera = { turn: -0.72, tilt: 0.46, zoom: 1 };
  const canvas = h('canvas', {
    class: 'plot surface', tabindex: 0, role: 'img',
    'aria-label': 'Surface of irradiance over bounce and ambient occlusion. Arrow keys turn it, plus and minus zoom.',
  });
  let drawn = false;
  const draw = () => {
    drawn = true;
    const density = Math.min(devicePixelRatio, 2);
    canvas.width = Math.max(1, Math.round(canvas.clientWidth * density));
    canvas.height = Math.max(1, Math.round(canvas.clientHeight * density));
    const frame = makeFrame(canvas, density, points, report.curves!.bounces, camera);
    frame.context.clearRect(0, 0, canvas.width, canvas.height);
    for (const part of [drawBox, drawSurface, drawLabels]) part(frame);
    canvas.dataset.drawn = 'yes';
  };
  let pending = false;
  const redraw = () => {
    if (!drawn || pending) return;
    pending = true;
    requestAnimationFrame(() => {
      pending = false;
      draw();
    });
  };
  const turn = (by: number, up: number) => {
    camera.turn += by;
    camera.tilt = Math.min(Math.max(camera.tilt + up, kTilts[0]), kTilts[1]);
    redraw();
  };
  const zoom = (by: number) => {
    camera.zoom = Math.min(Math.max(camera.zoom * by, 0.5), 3);
    redraw();
  };
  canvas.addEventListener('pointerdown', (event) => canvas.setPointerCapture(event.pointerId));
  canvas.addEventListener('pointermove', (event) => {
    if (canvas.hasPointerCapture(event.pointerId)) turn(event.movementX * 0.01, event.movementY * 0.008);
  });
  canvas.addEventListener('keydown', (event) => {
    const actions: Record<string, () => void> = {
      ArrowLeft: () => turn(-0.08, 0), ArrowRight: () => turn(0.08, 0), ArrowUp: () => turn(0, 0.06), ArrowDown: () => turn(0, -0.06),
      '+': () => zoom(1.1), '=': () => zoom(1.1), '-': () => zoom(0.9),
    };
    if (!actions[event.key] || event.ctrlKey || event.metaKey) return;
    event.preventDefault();
    actions[event.key]();
  });
  new IntersectionObserver((entries, observer) => {
    if (!entries.some((entry) => entry.isIntersecting)) return;
    observer.disconnect();
    draw();
  }, { rootMargin: '300px' }).observe(canvas);
  new ResizeObserver(redraw).observe(canvas);
  onThemeChange(redraw);
  addEventListener('beforeprint', draw);
  place('surface').append(canvas);
}

// Holds a frame: what is drawn, where to, and how it is seen.
interface Frame {
  context: CanvasRenderingContext2D;
  density: number; // pixels of the canvas per pixel of the page
  points: Point[];
  last: number; // bounce
  top: number; // largest E/π
  turn: [number, number]; // cosine, sine
  project(bounce: number, ao: number, value: number): Projected; // bounce 0..last, α 0..1, E/π 0..top, in parallel
}

function makeFrame(canvas: HTMLCanvasElement, density: number, points: Point[], bounces: number, camera: Camera): Frame {
  const last = bounces - 1, { width, height } = canvas;
  const top = Math.max(...points.map((point) => Math.max(...point.mean)));
  const [cosTurn, sinTurn] = [Math.cos(camera.turn), Math.sin(camera.turn)];
  const [cosTilt, sinTilt] = [Math.cos(camera.tilt), Math.sin(camera.tilt)];
  // The box and its labels fill the canvas.
  const boxWidth = Math.abs(cosTurn) + Math.abs(sinTurn);
  const boxHeight = kHeight * cosTilt + boxWidth * sinTilt;
  const scale = camera.zoom * Math.min((width - 120 * density) / boxWidth, (height - 92 * density) / boxHeight);
  const project = (bounce: number, ao: number, value: number): Projected => {
    const x = bounce / last - 0.5, y = ao - 0.5, z = (value / top - 0.5) * kHeight;
    const across = x * cosTurn - y * sinTurn, away = x * sinTurn + y * cosTurn;
    return [width / 2 + across * scale, height / 2 - 14 * density - (z * cosTilt + away * sinTilt) * scale, away * cosTilt - z * sinTilt];
  };
  return { context: canvas.getContext('2d')!, density, points, last, top, turn: [cosTurn, sinTurn], project };
}

// Draws the lines of the floor and of the two sides behind.
function drawBox({ context, density, last, top, turn: [cosTurn, sinTurn], project }: Frame): void {
  const farBounce = sinTurn > 0 ? last : 0, farAo = cosTurn > 0 ? 1 : 0;
  context.strokeStyle = theme().line;
  context.lineWidth = density;
  const stroke = (from: Projected, to: Projected) => {
    context.beginPath();
    context.moveTo(from[0], from[1]);
    context.lineTo(to[0], to[1]);
    context.stroke();
  };
  for (let i = 0; i <= 5; ++i) {
    const ao = i / 5, bounce = (i / 5) * last, value = (i / 5) * top;
    stroke(project(0, ao, 0), project(last, ao, 0));
    stroke(project(bounce, 0, 0), project(bounce, 1, 0));
    stroke(project(0, farAo, value), project(last, farAo, value));
    stroke(project(farBounce, 0, value), project(farBounce, 1, value));
    stroke(project(bounce, farAo, 0), project(bounce, farAo, top));
    stroke(project(farBounce, ao, 0), project(farBounce, ao, top));
  }
}

// Draws the quadrilaterals of the surface from far to near.
function drawSurface({ context, density, points, last, top, project }: Frame): void {
  const quads: { depth: number; corners: Projected[]; value: number }[] = [];
  for (let i = 0; i + 1 < points.length; ++i)
    for (let b = 0; b < last; ++b) {
      const corners = [[b, i], [b + 1, i], [b + 1, i + 1], [b, i + 1]].map(([bounce, j]) =>
        project(bounce, points[j].ao, points[j].mean[bounce]));
      quads.push({
        depth: corners.reduce((sum, corner) => sum + corner[2], 0) / 4,
        corners,
        value: (points[i].mean[b] + points[i].mean[b + 1] + points[i + 1].mean[b] + points[i + 1].mean[b + 1]) / 4,
      });
    }
  quads.sort((a, b) => b.depth - a.depth);
  const mesh = theme().dark ? 'rgba(0,0,0,0.28)' : 'rgba(255,255,255,0.3)';
  for (const { corners, value } of quads) {
    context.beginPath();
    corners.forEach(([x, y], k) => (k === 0 ? context.moveTo(x, y) : context.lineTo(x, y)));
    context.closePath();
    const color = heightColor(Math.sqrt(value / top));
    context.fillStyle = color;
    context.fill();
    // Its own colour on the seams, then a thin mesh.
    context.strokeStyle = color;
    context.lineWidth = density;
    context.stroke();
    context.strokeStyle = mesh;
    context.lineWidth = 0.6 * density;
    context.stroke();
  }
}

// Writes numbers and names outside the box, to the side where their edge runs.
function drawLabels({ context, density, last, top, turn: [cosTurn, sinTurn], project }: Frame): void {
  const { ink, faint } = theme();
  const nearBounce = sinTurn > 0 ? 0 : last, nearAo = cosTurn > 0 ? 0 : 1, farAo = 1 - nearAo;
  const write = (text: string, at: Projected, dx: number, dy: number, bold = false) => {
    context.font = `${bold ? 'bold ' : ''}${12 * density}px system-ui, sans-serif`;
    context.fillStyle = bold ? ink : faint;
    context.textAlign = 'center';
    context.textBaseline = 'middle';
    context.fillText(text, at[0] + dx * density, at[1] + dy * density);
  };
  const side = project(last / 2, nearAo, 0)[0] < project(nearBounce, 0.5, 0)[0] ? -1 : 1;
  for (let i = 0; i <= 5; ++i) {
    const bounce = (i / 5) * last, ao = i / 5;
    write(String(Math.round(bounce)), project(bounce, nearAo, 0), side * 9, 14);
    write(ao.toFixed(1), project(nearBounce, ao, 0), -side * 11, 14);
    if (i > 0) write(((i / 5) * top).toFixed(2), project(nearBounce, farAo, (i / 5) * top), sinTurn > 0 ? -22 : 22, 0);
  }
  write('bounce', project(last / 2, nearAo, 0), side * 44, 34, true);
  write('AO α', project(nearBounce, 0.5, 0), -side * 44, 34, true);
  write('E/π', project(nearBounce, farAo, top), 0, -16, true);
}
