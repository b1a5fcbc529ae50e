// Draws the picture by WebGL2.

import { modelOf, panelsOf, type Panel, type Picture, type Renderer } from './picture';
import type { Planes } from './planes';
import { kShowShader, kVertexShader, lightShader } from './viewer_shader';

// Returns null where there is no WebGL2 or the planes do not fit into a texture.
export function makeGlRenderer(canvas: HTMLCanvasElement, planes: Planes): Renderer | null {
  // Kept, so that a picture can be saved and printed.
  const context = canvas.getContext('webgl2', { alpha: true, antialias: false, depth: false, preserveDrawingBuffer: true });
  if (!context) return null;
  const gl = context;
  const layers = Math.ceil(listOf(planes).length / 8);
  if (
    layers > gl.getParameter(gl.MAX_ARRAY_TEXTURE_LAYERS) ||
    Math.max(planes.width, planes.height) > gl.getParameter(gl.MAX_TEXTURE_SIZE)
  )
    return null;

  let lights = new Map<string, Program>(); // by model and panel
  let show: Program, target: WebGLFramebuffer;
  let settings = ''; // of the texels as they are lit now
  const restore = () => {
    lights = new Map();
    settings = '';
    show = makeProgram(gl, kShowShader);
    uploadCorners(gl);
    uploadPlanes(gl, planes, layers);
    target = makeTarget(gl, planes.width, planes.height);
  };
  restore();
  canvas.addEventListener('webglcontextlost', (event) => event.preventDefault());
  canvas.addEventListener('webglcontextrestored', restore);

  // Lights the columns from..to − 1 of the bake.
  const light = (picture: Picture, panel: Panel, from: number, to: number) => {
    if (to <= from) return;
    const { data } = modelOf(picture, panel);
    const key = `${data.id} ${panel} ${picture.plain}`;
    if (!lights.has(key)) lights.set(key, makeProgram(gl, lightShader(data, panel, picture.plain)));
    const { program, at } = lights.get(key)!;
    gl.useProgram(program);
    gl.uniform1i(at('planes'), 0);
    gl.uniform1f(at('ao_step'), planes.aoStep);
    gl.uniform1f(at('irradiance_step'), planes.irradianceStep);
    gl.uniform1f(at('visibility_step'), planes.visibilityStep);
    gl.uniform1i(at('visibility_plane'), Math.max(listOf(planes).indexOf(planes.visibility), 0));
    gl.uniform1f(at('bounce_step'), planes.bounceStep);
    gl.uniform1i(at('bounce_plane'), Math.max(listOf(planes).indexOf(planes.bounce), 0));
    gl.uniform1i(at('last_bounce'), picture.lastBounce);
    gl.uniform3fv(at('albedo'), picture.albedo);
    gl.uniform3fv(at('shown'), picture.asColor ? picture.albedo : [1, 1, 1]);
    gl.uniform1f(at('gain'), 2 ** picture.exposure);
    gl.uniform1f(at('range'), picture.range);
    gl.scissor(from, 0, to - from, planes.height);
    gl.drawArrays(gl.TRIANGLES, 0, 3);
  };

  const lightAll = (picture: Picture) => {
    gl.bindFramebuffer(gl.FRAMEBUFFER, target);
    gl.viewport(0, 0, planes.width, planes.height);
    gl.enable(gl.SCISSOR_TEST);
    for (const [panel, from, to] of panelsOf(picture, planes.width)) light(picture, panel, from, to);
    gl.disable(gl.SCISSOR_TEST);
    gl.bindFramebuffer(gl.FRAMEBUFFER, null);
  };

  return {
    name: 'WebGL2',
    draw(picture) {
      if (gl.isContextLost()) return;
      const wanted = JSON.stringify([
        picture.model.data.id, picture.plain, picture.albedo, picture.exposure, picture.asColor, picture.lastBounce, picture.range,
        panelsOf(picture, planes.width),
      ]);
      if (wanted !== settings) lightAll(picture);
      settings = wanted;
      gl.viewport(0, 0, canvas.width, canvas.height);
      gl.useProgram(show.program);
      gl.uniform1i(show.at('lit'), 1);
      gl.uniform1f(show.at('canvas_height'), canvas.height);
      gl.uniform2f(show.at('origin'), picture.originX, picture.originY);
      gl.uniform1f(show.at('texels_per_pixel'), picture.texelsPerPixel);
      gl.drawArrays(gl.TRIANGLES, 0, 3);
    },
  };
}

// Makes the texture that texels are lit into; it stays bound as texture 1.
function makeTarget(gl: WebGL2RenderingContext, width: number, height: number): WebGLFramebuffer {
  gl.activeTexture(gl.TEXTURE1);
  const texture = gl.createTexture();
  gl.bindTexture(gl.TEXTURE_2D, texture);
  gl.texStorage2D(gl.TEXTURE_2D, 1, gl.RGBA8, width, height);
  for (const side of [gl.TEXTURE_MIN_FILTER, gl.TEXTURE_MAG_FILTER]) gl.texParameteri(gl.TEXTURE_2D, side, gl.NEAREST);
  const target = gl.createFramebuffer()!;
  gl.bindFramebuffer(gl.FRAMEBUFFER, target);
  gl.framebufferTexture2D(gl.FRAMEBUFFER, gl.COLOR_ATTACHMENT0, gl.TEXTURE_2D, texture, 0);
  gl.bindFramebuffer(gl.FRAMEBUFFER, null);
  return target;
}

interface Program {
  program: WebGLProgram;
  at(uniform: string): WebGLUniformLocation | null;
}

function makeProgram(gl: WebGL2RenderingContext, fragment: string): Program {
  const program = gl.createProgram()!;
  for (const [type, source] of [
    [gl.VERTEX_SHADER, kVertexShader],
    [gl.FRAGMENT_SHADER, fragment],
  ] as const) {
    const shader = gl.createShader(type)!;
    gl.shaderSource(shader, source);
    gl.compileShader(shader);
    if (!gl.getShaderParameter(shader, gl.COMPILE_STATUS)) throw new Error(`shader: ${gl.getShaderInfoLog(shader)}`);
    gl.attachShader(program, shader);
  }
  gl.bindAttribLocation(program, 0, 'corner');
  gl.linkProgram(program);
  if (!gl.getProgramParameter(program, gl.LINK_STATUS)) throw new Error(`shader: ${gl.getProgramInfoLog(program)}`);
  const places = new Map<string, WebGLUniformLocation | null>();
  return {
    program,
    at(uniform) {
      if (!places.has(uniform)) places.set(uniform, gl.getUniformLocation(program, uniform));
      return places.get(uniform)!;
    },
  };
}

// Uploads one triangle over the whole canvas.
function uploadCorners(gl: WebGL2RenderingContext): void {
  gl.bindBuffer(gl.ARRAY_BUFFER, gl.createBuffer());
  gl.bufferData(gl.ARRAY_BUFFER, new Float32Array([-1, -1, 3, -1, -1, 3]), gl.STATIC_DRAW);
  gl.enableVertexAttribArray(0);
  gl.vertexAttribPointer(0, 2, gl.FLOAT, false, 0, 0);
}

// Returns the planes in the order of the texture: α, E₀, E₁, …, then the bounce map, and V where there is no E₀.
function listOf(planes: Planes): (Uint16Array | null)[] {
  const all = [planes.ao, ...planes.irradiance];
  for (const plane of [planes.bounce, planes.visibility]) if (plane && !all.includes(plane)) all.push(plane);
  return all;
}

// Uploads the planes as texture 0.
function uploadPlanes(gl: WebGL2RenderingContext, planes: Planes, layers: number): void {
  const { width, height } = planes;
  gl.activeTexture(gl.TEXTURE0);
  gl.bindTexture(gl.TEXTURE_2D_ARRAY, gl.createTexture());
  gl.pixelStorei(gl.UNPACK_ALIGNMENT, 1);
  gl.texStorage3D(gl.TEXTURE_2D_ARRAY, 1, gl.RGBA32UI, width, height, layers);
  for (const side of [gl.TEXTURE_MIN_FILTER, gl.TEXTURE_MAG_FILTER])
    gl.texParameteri(gl.TEXTURE_2D_ARRAY, side, gl.NEAREST);
  const all = listOf(planes);
  const layer = new Uint32Array(4 * width * height);
  for (let l = 0; l < layers; ++l) {
    for (let part = 0; part < 4; ++part) {
      const low = all[8 * l + 2 * part], high = all[8 * l + 2 * part + 1];
      for (let i = 0; i < width * height; ++i) layer[4 * i + part] = (low ? low[i] : 0) | ((high ? high[i] : 0) << 16);
    }
    gl.texSubImage3D(gl.TEXTURE_2D_ARRAY, 0, 0, 0, l, width, height, 1, gl.RGBA_INTEGER, gl.UNSIGNED_INT, layer);
  }
}
