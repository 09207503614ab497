// A map in metres, east to the right: roads, lines and what else is drawn on it. Drag to move, pinch or turn
// the wheel to zoom.
import { ink, onColours, tokensOf } from "./palette";
import type { Line, Numbers } from "./plot";
import { roundStep } from "./round";

export type Draw = (map: MapView, context: CanvasRenderingContext2D) => void;

interface Box {
  west: number;
  south: number;
  east: number;
  north: number;
}

export class MapView {
  roads: Line[] = [];
  lines: Line[] = [];
  extra: Draw = () => undefined; // on top
  inMetres = true; // a bar shows the scale

  private readonly context: CanvasRenderingContext2D;
  private east = 0; // of the middle
  private north = 0;
  private scale = 1; // px a metre
  private width = 0; // px, of the canvas when it was measured; asking it for each point would take most of the time
  private height = 0;
  private readonly fingers = new Map<number, PointerEvent>();
  private waiting = false;

  // `wheel`: whether the wheel alone zooms; else with Ctrl, so that a page can be scrolled.
  constructor(
    readonly canvas: HTMLCanvasElement,
    private readonly wheel: boolean,
  ) {
    this.context = canvas.getContext("2d")!;
    canvas.addEventListener("wheel", (e) => this.wheelTurned(e), { passive: false });
    canvas.addEventListener("pointerdown", (e) => this.down(e));
    canvas.addEventListener("pointermove", (e) => this.moved(e));
    for (const end of ["pointerup", "pointercancel"] as const) {
      canvas.addEventListener(end, (e) => this.fingers.delete(e.pointerId));
    }
    new ResizeObserver(() => this.draw()).observe(canvas);
    onColours(() => this.redraw());
  }

  x(east: number): number {
    return this.width / 2 + (east - this.east) * this.scale;
  }

  y(north: number): number {
    return this.height / 2 - (north - this.north) * this.scale;
  }

  metres(length: number): number {
    return length * this.scale;
  }

  shows(east: number, north: number): boolean {
    const [x, y] = [this.x(east), this.y(north)];
    return x >= 0 && x <= this.width && y >= 0 && y <= this.height;
  }

  // The name of the road at a place of the canvas, if there is one.
  roadAt(x: number, y: number): string {
    let [nearest, name] = [10, ""]; // px
    for (const road of this.roads)
      for (let i = 1; i < road.x.length; ++i) {
        const [ax, ay] = [this.x(road.x[i - 1]!) - x, this.y(road.y[i - 1]!) - y];
        const [dx, dy] = [this.x(road.x[i]!) - x - ax, this.y(road.y[i]!) - y - ay];
        const share = Math.min(Math.max(-(ax * dx + ay * dy) / (dx * dx + dy * dy || 1), 0), 1);
        const apart = Math.hypot(ax + share * dx, ay + share * dy);
        if (apart < nearest) [nearest, name] = [apart, road.name];
      }
    return name;
  }

  centre(east: number, north: number): void {
    this.east = east;
    this.north = north;
    this.redraw();
  }

  zoom(factor: number, x = this.canvas.clientWidth / 2, y = this.canvas.clientHeight / 2): void {
    const kept = Math.min(Math.max(this.scale * factor, 1e-3), 1e3);
    const dx = (x - this.canvas.clientWidth / 2) / this.scale;
    const dy = (this.canvas.clientHeight / 2 - y) / this.scale;
    this.east += dx - (dx * this.scale) / kept;
    this.north += dy - (dy * this.scale) / kept;
    this.scale = kept;
    this.redraw();
  }

  // Shows all lines.
  fit(): void {
    const box = boxOf(this.lines);
    if (!box) return;
    this.measure();
    const [width, height] = [Math.max(this.width, 1), Math.max(this.height, 1)];
    this.east = (box.west + box.east) / 2;
    this.north = (box.south + box.north) / 2;
    const metres = 20; // at least
    this.scale =
      0.88 *
      Math.min(width / Math.max(box.east - box.west, metres), height / Math.max(box.north - box.south, metres));
    this.redraw();
  }

  redraw(): void {
    if (this.waiting) return;
    this.waiting = true;
    requestAnimationFrame(() => {
      this.waiting = false;
      this.draw();
    });
  }

  private measure(): void {
    [this.width, this.height] = [this.canvas.clientWidth, this.canvas.clientHeight];
  }

  private draw(): void {
    const { canvas, context } = this;
    const ratio = window.devicePixelRatio || 1;
    this.measure();
    const { width, height } = this;
    if (canvas.width !== Math.round(width * ratio) || canvas.height !== Math.round(height * ratio)) {
      canvas.width = Math.round(width * ratio);
      canvas.height = Math.round(height * ratio);
    }
    context.setTransform(ratio, 0, 0, ratio, 0, 0);
    context.clearRect(0, 0, width, height);
    context.lineJoin = context.lineCap = "round";
    const road = Math.min(Math.max(this.metres(7), 2), 14);
    for (const [token, grow] of [["road-edge", 2], ["road", 0]] as const) {
      context.strokeStyle = ink(token);
      context.lineWidth = road + grow;
      for (const line of this.roads) this.stroke(line.x, line.y);
    }
    const tokens = tokensOf(this.lines.map((line) => line.name));
    this.lines.forEach((line, i) => {
      context.strokeStyle = context.fillStyle = ink(line.token ?? tokens[i]!);
      if (line.look === "points") return this.dots(line.x, line.y);
      context.setLineDash(line.look === "dashed" ? [6, 5] : []);
      context.lineWidth = line.width ?? 2;
      context.globalAlpha = line.opacity ?? 1;
      this.stroke(line.x, line.y);
      context.globalAlpha = 1;
    });
    context.setLineDash([]);
    this.extra(this, context);
    if (this.inMetres) this.drawScale();
  }

  dots(east: Numbers, north: Numbers): void {
    const { context } = this;
    let [last_x, last_y] = [NaN, NaN];
    for (let i = 0; i < east.length; ++i) {
      const [e, n] = [east[i], north[i]];
      if (e == null || n == null) continue;
      const [x, y] = [this.x(e), this.y(n)];
      if (Math.hypot(x - last_x, y - last_y) < 0.5) continue; // it is not seen beside the last one
      [last_x, last_y] = [x, y];
      context.beginPath();
      context.arc(x, y, 2.5, 0, 2 * Math.PI);
      context.fill();
    }
  }

  stroke(east: Numbers, north: Numbers): void {
    const { context } = this;
    context.beginPath();
    let [pen, last_x, last_y] = [false, 0, 0];
    for (let i = 0; i < east.length; ++i) {
      const [e, n] = [east[i], north[i]];
      if (e == null || n == null) {
        pen = false;
        continue;
      }
      const [x, y] = [this.x(e), this.y(n)];
      if (pen && i + 1 < east.length && Math.hypot(x - last_x, y - last_y) < 0.5) continue; // it is not seen
      if (pen) context.lineTo(x, y);
      else context.moveTo(x, y);
      [pen, last_x, last_y] = [true, x, y];
    }
    context.stroke();
  }

  private drawScale(): void {
    const { context, canvas } = this;
    const length = roundStep(90 / this.scale);
    const [x, y] = [12, canvas.clientHeight - 12];
    context.strokeStyle = context.fillStyle = ink("soft");
    context.lineWidth = 2;
    context.beginPath();
    context.moveTo(x, y - 5);
    context.lineTo(x, y);
    context.lineTo(x + length * this.scale, y);
    context.lineTo(x + length * this.scale, y - 5);
    context.stroke();
    context.font = "12px system-ui, sans-serif";
    context.fillText(length >= 1000 ? `${length / 1000} km` : `${length} m`, x + 4, y - 6);
  }

  private wheelTurned(e: WheelEvent): void {
    if (!this.wheel && !e.ctrlKey && !e.metaKey) return;
    e.preventDefault();
    this.zoom(Math.exp(-0.0015 * e.deltaY), e.offsetX, e.offsetY);
  }

  private down(e: PointerEvent): void {
    this.canvas.setPointerCapture(e.pointerId);
    this.fingers.set(e.pointerId, e);
  }

  private moved(e: PointerEvent): void {
    const before = this.fingers.get(e.pointerId);
    if (!before) return;
    const other = [...this.fingers.values()].find((f) => f.pointerId !== e.pointerId);
    const share = other ? 0.5 : 1; // each of two fingers moves the map by half
    this.east -= (share * (e.offsetX - before.offsetX)) / this.scale;
    this.north += (share * (e.offsetY - before.offsetY)) / this.scale;
    if (other) {
      const apart = (f: PointerEvent) => Math.hypot(f.offsetX - other.offsetX, f.offsetY - other.offsetY);
      if (apart(before) > 1) {
        this.zoom(apart(e) / apart(before), (e.offsetX + other.offsetX) / 2, (e.offsetY + other.offsetY) / 2);
      }
    }
    this.fingers.set(e.pointerId, e);
    this.redraw();
  }
}

function boxOf(lines: Line[]): Box | undefined {
  const box = { west: Infinity, south: Infinity, east: -Infinity, north: -Infinity };
  for (const line of lines) {
    for (let i = 0; i < line.x.length; ++i) {
      const [e, n] = [line.x[i], line.y[i]];
      if (e == null || n == null) continue;
      box.west = Math.min(box.west, e);
      box.east = Math.max(box.east, e);
      box.south = Math.min(box.south, n);
      box.north = Math.max(box.north, n);
    }
  }
  return box.west <= box.east ? box : undefined;
}
