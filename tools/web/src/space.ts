// Clouds and thick lines in 3-D, drawn by WebGL 2: x east, y north, z up, in metres.
import { ink } from "./palette";

const steps = 5; // of the ramp of colours

const cloud_source = `#version 300 es
uniform mat4 view;
uniform vec3 ramp[${steps}];
uniform vec2 heights; // the lowest, and from there to the highest; m
uniform float metre; // px, at a distance of a metre
in vec3 place;
out vec4 colour;
void main() {
  gl_Position = view * vec4(place, 1.0);
  gl_PointSize = clamp(0.12 * metre / gl_Position.w, 2.0, 9.0);
  colour = vec4(ramp[int(clamp(${steps}.0 * (place.z - heights.x) / heights.y, 0.0, ${steps - 1}.0))], 1.0);
}`;

// Four corners about each part of a line, as wide as it says in metres on the ground and in px on the screen.
const lines_source = `#version 300 es
uniform mat4 view;
uniform vec2 screen; // px
uniform vec2 width; // m, px
uniform vec4 paint;
in vec3 place;
in vec3 next;
out vec4 colour;
const float near = 0.2;
void main() {
  vec4 a = view * vec4(place, 1.0), b = view * vec4(next, 1.0);
  if (max(a.w, b.w) < near) { gl_Position = vec4(2.0, 2.0, 2.0, 1.0); return; }
  vec4 front = a.w < near ? mix(b, a, (b.w - near) / (b.w - a.w)) : a;
  vec4 back = b.w < near ? mix(a, b, (a.w - near) / (a.w - b.w)) : b;
  vec2 along = (back.xy / back.w - front.xy / front.w) * screen;
  along = dot(along, along) > 0.0 ? normalize(along) : vec2(1.0, 0.0);
  vec2 flat_along = next.xy - place.xy;
  flat_along = dot(flat_along, flat_along) > 0.0 ? normalize(flat_along) : vec2(0.0);
  float side = gl_VertexID % 2 == 0 ? 0.5 : -0.5;
  gl_Position = (gl_VertexID < 2 ? front : back) + side * width.x * (view * vec4(-flat_along.y, flat_along.x, 0.0, 0.0));
  gl_Position.xy += side * width.y * 2.0 * vec2(-along.y, along.x) / screen * gl_Position.w;
  colour = paint;
}`;

const paint_source = `#version 300 es
precision mediump float;
in vec4 colour;
out vec4 painted;
void main() { painted = colour; }`;

// `points`: three numbers each; the same array is sent to the graphics once.
export interface Cloud {
  points: Float32Array;
  heights: [lowest: number, range: number];
}
export interface Lines {
  points: Float32Array;
  look: "chain" | "pairs"; // one line through all points, or one from each first to each second
  token: string; // of its colour
  opacity?: number;
  metres?: number; // its width on the ground ...
  px?: number; // ... and on the screen
  isBeneath?: boolean; // everything else hides it
}

export interface Eye {
  view: Float32Array; // 4 by 4, by columns
  metre: number; // px, at a distance of a metre
}

function numbers(token: string): [number, number, number] {
  return ink(token).match(/[\d.]+/g)!.slice(0, 3).map((v) => Number(v) / 255) as [number, number, number];
}

export class Space {
  private readonly buffers = new Map<Float32Array, WebGLBuffer>();
  private cloud!: WebGLProgram;
  private lines!: WebGLProgram;

  // Nothing where the browser has no WebGL 2. Smooth edges would take half of the time without a graphics processor.
  static on(canvas: HTMLCanvasElement, restored: () => void): Space | undefined {
    const gl = canvas.getContext("webgl2", { antialias: false });
    return gl ? new Space(gl, restored) : undefined;
  }

  private constructor(private readonly gl: WebGL2RenderingContext, restored: () => void) {
    this.start();
    gl.canvas.addEventListener("webglcontextlost", (e) => e.preventDefault());
    gl.canvas.addEventListener("webglcontextrestored", () => {
      this.buffers.clear();
      this.start();
      restored();
    });
  }

  // Of clouds every `nth` point.
  draw({ view, metre }: Eye, lines: Lines[], clouds: Cloud[], nth: number): void {
    const { gl } = this;
    const { width, height } = gl.canvas;
    gl.viewport(0, 0, width, height);
    gl.clearColor(...numbers("ground"), 1);
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    const unused = new Set(this.buffers.keys());
    gl.useProgram(this.cloud);
    gl.uniformMatrix4fv(this.uniform(this.cloud, "view"), false, view);
    gl.uniform1f(this.uniform(this.cloud, "metre"), metre);
    gl.uniform3fv(this.uniform(this.cloud, "ramp"), Array.from({ length: steps }, (_, i) => numbers(`ramp-${i + 1}`)).flat());
    gl.useProgram(this.lines);
    gl.uniformMatrix4fv(this.uniform(this.lines, "view"), false, view);
    gl.uniform2f(this.uniform(this.lines, "screen"), width, height);
    for (const line of lines.filter((l) => l.isBeneath)) this.drawLines(line, unused);
    gl.useProgram(this.cloud);
    gl.disable(gl.BLEND);
    for (const cloud of clouds) this.drawCloud(cloud, nth, unused);
    gl.enable(gl.BLEND);
    gl.useProgram(this.lines);
    for (const line of lines.filter((l) => !l.isBeneath)) this.drawLines(line, unused);
    for (const points of unused) {
      gl.deleteBuffer(this.buffers.get(points)!);
      this.buffers.delete(points);
    }
  }

  private start(): void {
    const { gl } = this;
    this.cloud = this.program(cloud_source);
    this.lines = this.program(lines_source);
    gl.blendFunc(gl.SRC_ALPHA, gl.ONE_MINUS_SRC_ALPHA);
    gl.enableVertexAttribArray(0);
  }

  private program(vertices: string): WebGLProgram {
    const { gl } = this;
    const program = gl.createProgram()!;
    for (const [kind, source] of [[gl.VERTEX_SHADER, vertices], [gl.FRAGMENT_SHADER, paint_source]] as const) {
      const shader = gl.createShader(kind)!;
      gl.shaderSource(shader, source);
      gl.compileShader(shader);
      gl.attachShader(program, shader);
    }
    gl.bindAttribLocation(program, 0, "place");
    gl.bindAttribLocation(program, 1, "next");
    gl.linkProgram(program);
    if (!gl.getProgramParameter(program, gl.LINK_STATUS) && !gl.isContextLost()) throw new Error(gl.getProgramInfoLog(program)!);
    return program;
  }

  private uniform(program: WebGLProgram, name: string): WebGLUniformLocation | null {
    return this.gl.getUniformLocation(program, name);
  }

  private bind(points: Float32Array, unused: Set<Float32Array>): void {
    const { gl } = this;
    unused.delete(points);
    const known = this.buffers.get(points);
    const buffer = known ?? gl.createBuffer()!;
    gl.bindBuffer(gl.ARRAY_BUFFER, buffer);
    if (known) return;
    gl.bufferData(gl.ARRAY_BUFFER, points, gl.STATIC_DRAW);
    this.buffers.set(points, buffer);
  }

  private drawCloud({ points, heights }: Cloud, nth: number, unused: Set<Float32Array>): void {
    const { gl } = this;
    this.bind(points, unused);
    gl.enable(gl.DEPTH_TEST);
    gl.disableVertexAttribArray(1);
    gl.vertexAttribPointer(0, 3, gl.FLOAT, false, 12 * nth, 0);
    gl.vertexAttribDivisor(0, 0);
    gl.uniform2f(this.uniform(this.cloud, "heights"), ...heights);
    gl.drawArrays(gl.POINTS, 0, Math.floor(points.length / 3 / nth));
  }

  private drawLines(line: Lines, unused: Set<Float32Array>): void {
    const { gl } = this;
    const count = line.look === "chain" ? line.points.length / 3 - 1 : line.points.length / 6;
    if (count <= 0) return;
    this.bind(line.points, unused);
    (line.isBeneath ? gl.disable : gl.enable).call(gl, gl.DEPTH_TEST);
    gl.enableVertexAttribArray(1);
    for (const attribute of [0, 1]) {
      gl.vertexAttribPointer(attribute, 3, gl.FLOAT, false, line.look === "chain" ? 12 : 24, 12 * attribute);
      gl.vertexAttribDivisor(attribute, 1);
    }
    gl.uniform2f(this.uniform(this.lines, "width"), line.metres ?? 0, (line.px ?? 0) * devicePixelRatio);
    gl.uniform4f(this.uniform(this.lines, "paint"), ...numbers(line.token), line.opacity ?? 1);
    gl.drawArraysInstanced(gl.TRIANGLE_STRIP, 0, 4, count);
  }
}
