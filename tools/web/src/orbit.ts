// An eye that circles a place: drag to turn, with the right button, Shift or two fingers to move, wheel or pinch to zoom.
// Keys do the same: arrows turn, with Shift move, + and - zoom.
import type { Eye } from "./space";

const field = Math.tan((25 * Math.PI) / 180); // of half the height
const [nearest, farthest] = [4, 4000]; // m
const key_turn = 0.1; // rad
const key_move = 40; // px

export class Orbit {
  target: number[] = [0, 0, 0];
  private azimuth = -0.6; // rad, of the eye's look, clockwise from north
  private elevation = 0.5; // rad, of the eye above the target
  private distance = 45; // m
  private readonly fingers = new Map<number, PointerEvent>();

  // `moved` is called when the target was moved by hand.
  constructor(
    private readonly canvas: HTMLCanvasElement,
    private readonly changed: () => void,
    private readonly moved: () => void,
  ) {
    canvas.addEventListener("contextmenu", (e) => e.preventDefault());
    canvas.addEventListener("wheel", (e) => {
      e.preventDefault();
      this.zoom(Math.exp(-0.0015 * e.deltaY));
    }, { passive: false });
    canvas.addEventListener("pointerdown", (e) => {
      canvas.setPointerCapture(e.pointerId);
      this.fingers.set(e.pointerId, e);
    });
    canvas.addEventListener("pointermove", (e) => this.dragged(e));
    for (const end of ["pointerup", "pointercancel"] as const) {
      canvas.addEventListener(end, (e) => this.fingers.delete(e.pointerId));
    }
    canvas.addEventListener("keydown", (e) => this.pressed(e));
  }

  // Whether a finger or the mouse holds the ground.
  get isHeld(): boolean {
    return this.fingers.size > 0;
  }

  zoom(factor: number): void {
    this.distance = Math.min(Math.max(this.distance / factor, nearest), farthest);
    this.changed();
  }

  // Looks at a circle from above.
  fit(place: number[], radius: number): void {
    this.target = place;
    this.elevation = 1.2;
    this.distance = Math.min(Math.max((1.2 * radius) / field, nearest), farthest);
    this.changed();
  }

  // The matrix turns the ground into the eye's axes, and those into the screen.
  eye(width: number, height: number): Eye {
    const [sa, ca, se, ce] = [Math.sin(this.azimuth), Math.cos(this.azimuth), Math.sin(this.elevation), Math.cos(this.elevation)];
    const rows = [[ca, -sa, 0], [sa * se, ca * se, ce], [sa * ce, ca * ce, -se]]; // right, up, ahead
    const [near, far] = [0.2, 3 * this.distance + 6000];
    const scales = [height / width / field, 1 / field, (far + near) / (far - near), 1];
    const view = new Float32Array(16);
    [rows[0]!, rows[1]!, rows[2]!, rows[2]!].forEach((row, i) => {
      const shift = -row.reduce((sum, v, k) => sum + v * this.target[k]!, 0) + (i >= 2 ? this.distance : 0);
      [...row, shift].forEach((v, k) => (view[4 * k + i] = scales[i]! * v));
    });
    view[14]! -= (2 * far * near) / (far - near);
    return { view, metre: height / 2 / field };
  }

  private turn(right: number, up: number): void {
    this.azimuth += right;
    this.elevation = Math.min(Math.max(this.elevation + up, 0.03), Math.PI / 2 - 0.001);
    this.changed();
  }

  // Takes the ground along by this many px.
  private move(right: number, down: number): void {
    const metres = (2 * field * this.distance) / Math.max(this.canvas.clientHeight, 1);
    const [x, y] = [-right * metres, (down * metres) / Math.max(Math.sin(this.elevation), 0.3)];
    const [sa, ca] = [Math.sin(this.azimuth), Math.cos(this.azimuth)];
    this.target = [this.target[0]! + x * ca + y * sa, this.target[1]! - x * sa + y * ca, this.target[2]!];
    this.moved();
    this.changed();
  }

  private dragged(e: PointerEvent): void {
    const before = this.fingers.get(e.pointerId);
    if (!before) return;
    const [dx, dy] = [e.offsetX - before.offsetX, e.offsetY - before.offsetY];
    this.fingers.set(e.pointerId, e);
    const other = [...this.fingers.values()].find((f) => f.pointerId !== e.pointerId);
    if (other) {
      const apart = (f: PointerEvent) => Math.max(Math.hypot(f.offsetX - other.offsetX, f.offsetY - other.offsetY), 1);
      this.zoom(apart(e) / apart(before));
      this.move(dx / 2, dy / 2); // each of two fingers moves by half
    } else if (e.shiftKey || (e.buttons & 6) !== 0) {
      this.move(dx, dy);
    } else {
      this.turn(0.006 * dx, 0.006 * dy);
    }
  }

  private pressed(e: KeyboardEvent): void {
    const arrows: Record<string, [number, number]> = { ArrowLeft: [1, 0], ArrowRight: [-1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] };
    const arrow = arrows[e.key];
    if (arrow && e.shiftKey) this.move(key_move * arrow[0], key_move * arrow[1]);
    else if (arrow) this.turn(key_turn * arrow[0], key_turn * arrow[1]);
    else if (e.key === "+" || e.key === "=") this.zoom(1.25);
    else if (e.key === "-") this.zoom(0.8);
    else return;
    e.preventDefault();
  }
}
