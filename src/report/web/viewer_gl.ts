// The picture by WebGL2.

import type { Model } from './model';
import type { Planes } from './planes';
import { kViews, type Picture, type Renderer } from './viewer';
import { fragmentShader, kVertexShader } from './viewer_shader';

// null where there is no WebGL2, or the planes do not fit into a texture.
export function makeGlRenderer(canvas: HTMLCanvasElement, planes: Planes): Renderer | null {
  // Kept, so that a picture can be saved and printed.
  const context = canvas.getContext('webgl2', { alpha: true, antialias: false, depth: false, preserveDrawingBuffer: true });
  if (!context) return null;
  const gl = context;
  const layers = Math.ceil((planes.irradiance.length + 1) / 4);
  if (
    layers > gl.getParameter(gl.MAX_ARRAY_TEXTURE_LAYERS) ||
    Math.max(planes.width, planes.height) > gl.getParameter(gl.MAX_TEXTURE_SIZE)
  )
    return null;

  let programs = new Map<Model, Program>();
  const restore = () => {
    programs = new Map();
    uploadCorners(gl);
    uploadPlanes(gl, planes, layers);
  };
  restore();
  canvas.addEventListener('webglcontextlost', (event) => event.preventDefault());
  canvas.addEventListener('webglcontextrestored', restore);

  return {
    name: 'WebGL2',
    draw(picture: Picture) {
      if (gl.isContextLost()) return;
      if (!programs.has(picture.model)) programs.set(picture.model, makeProgram(gl, picture.model.data.shader.glsl));
      const { program, at } = programs.get(picture.model)!;
      gl.viewport(0, 0, canvas.width, canvas.height);
      gl.useProgram(program);
      gl.uniform2f(at('canvas_size'), canvas.width, canvas.height);
      gl.uniform2f(at('origin'), picture.originX, picture.originY);
      gl.uniform1f(at('texels_per_pixel'), picture.texelsPerPixel);
      gl.uniform1f(at('ao_step'), planes.aoStep);
      gl.uniform1f(at('irradiance_step'), planes.irradianceStep);
      gl.uniform1i(at('layers'), layers);
      gl.uniform1i(at('last_bounce'), picture.lastBounce);
      gl.uniform3f(at('albedo'), ...picture.albedo);
      gl.uniform1f(at('gain'), 2 ** picture.exposure);
      gl.uniform1i(at('view'), kViews.indexOf(picture.view));
      gl.uniform1i(at('as_color'), picture.asColor ? 1 : 0);
      gl.uniform2f(at('dividers'), ...picture.dividers);
      gl.uniform1f(at('range'), picture.range);
      gl.drawArrays(gl.TRIANGLES, 0, 3);
    },
  };
}

interface Program {
  program: WebGLProgram;
  at(uniform: string): WebGLUniformLocation | null;
}

function makeProgram(gl: WebGL2RenderingContext, model: string): Program {
  const program = gl.createProgram()!;
  for (const [type, source] of [
    [gl.VERTEX_SHADER, kVertexShader],
    [gl.FRAGMENT_SHADER, fragmentShader(model)],
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

// One triangle over the whole canvas.
function uploadCorners(gl: WebGL2RenderingContext): void {
  gl.bindBuffer(gl.ARRAY_BUFFER, gl.createBuffer());
  gl.bufferData(gl.ARRAY_BUFFER, new Float32Array([-1, -1, 3, -1, -1, 3]), gl.STATIC_DRAW);
  gl.enableVertexAttribArray(0);
  gl.vertexAttribPointer(0, 2, gl.FLOAT, false, 0, 0);
}

function uploadPlanes(gl: WebGL2RenderingContext, planes: Planes, layers: number): void {
  const { width, height } = planes;
  gl.bindTexture(gl.TEXTURE_2D_ARRAY, gl.createTexture());
  gl.pixelStorei(gl.UNPACK_ALIGNMENT, 1);
  gl.texStorage3D(gl.TEXTURE_2D_ARRAY, 1, gl.RGBA16UI, width, height, layers);
  for (const side of [gl.TEXTURE_MIN_FILTER, gl.TEXTURE_MAG_FILTER])
    gl.texParameteri(gl.TEXTURE_2D_ARRAY, side, gl.NEAREST);
  const all = [planes.ao, ...planes.irradiance];
  const layer = new Uint16Array(4 * width * height);
  for (let l = 0; l < layers; ++l) {
    for (let part = 0; part < 4; ++part) {
      const plane = all[4 * l + part];
      for (let i = 0; i < width * height; ++i) layer[4 * i + part] = plane ? plane[i] : 0;
    }
    gl.texSubImage3D(gl.TEXTURE_2D_ARRAY, 0, 0, 0, l, width, height, 1, gl.RGBA_INTEGER, gl.UNSIGNED_SHORT, layer);
  }
}
