// The runs and the truth seen from above, with where they are at the cursor.
import { between, nearest, type Component, type Data, type Run, type Track } from "./comparison_data";
import { button, element } from "./dom";
import type { View } from "./linked_charts";
import { MapView } from "./map";
import { ink } from "./palette";
import type { Line } from "./plot";

const steps = 5; // of the ramp of colours

function part(track: Track, view: View): [number, number] {
  return [nearest(track.time, view.from), nearest(track.time, view.to) + 1];
}

export class Plane {
  visible: boolean[];
  isColoured = false;
  component: Component = "absolute";

  private readonly map: MapView;
  private readonly scale: HTMLElement;
  private view: View = { at: 0, from: 0, to: 0 };

  constructor(
    parent: HTMLElement,
    private readonly data: Data,
    private readonly tokens: string[],
    pointed: (time: number) => void,
  ) {
    this.visible = data.runs.map(() => true);
    const figure = element("figure", parent, "", "map");
    element("figcaption", figure, "Seen from above, the truth beneath");
    const frame = element("div", figure, "", "frame");
    const canvas = element("canvas", frame, "", "map") as HTMLCanvasElement;
    canvas.setAttribute("role", "img");
    canvas.setAttribute("aria-label", "Trajectories seen from above");
    this.map = new MapView(canvas, false);
    this.map.extra = (map, context) => this.drawMarkers(map, context);
    const buttons = element("div", frame, "", "buttons");
    button(buttons, "+", "Nearer", () => this.map.zoom(1.5));
    button(buttons, "−", "Farther", () => this.map.zoom(1 / 1.5));
    button(buttons, "⤢", "Show the whole way", () => this.map.fit());
    this.scale = element("div", figure, "", "legend");
    canvas.addEventListener("pointermove", (e) => {
      const time = e.buttons === 0 ? this.timeAt(e.offsetX, e.offsetY) : undefined;
      if (time !== undefined) pointed(time);
    });
  }

  show(view: View): void {
    const isOther = view.from !== this.view.from || view.to !== this.view.to;
    this.view = { ...view };
    if (isOther) this.refresh(true);
    else this.map.redraw();
  }

  // After a change of what is shown.
  refresh(fit = false): void {
    const { truth, runs } = this.data;
    const runLines = this.isColoured ? [] : this.shown().map(([run, token]) => this.lineOf(run, token, 2));
    const beneath = { ...this.lineOf(truth, "truth", 7), opacity: 0.35 };
    this.map.lines = [beneath, ...runLines];
    if (fit) this.map.fit();
    this.showScale(runs);
    this.map.redraw();
  }

  private shown(): [Run, string][] {
    return this.data.runs.flatMap((run, i) => (this.visible[i] ? [[run, this.tokens[i]!] as [Run, string]] : []));
  }

  private lineOf(track: Track, token: string, width: number): Line {
    const [from, to] = part(track, this.view);
    return { name: track.name, x: track.x.slice(from, to), y: track.y.slice(from, to), token, width };
  }

  private largest(runs: Run[]): number {
    return runs.reduce((most, run) => run[this.component].reduce((m, v) => Math.max(m, Math.abs(v)), most), 1e-9);
  }

  private showScale(runs: Run[]): void {
    this.scale.replaceChildren();
    if (!this.isColoured) return;
    const most = this.largest(runs);
    for (let k = 1; k <= steps; ++k) {
      const key = element("span", this.scale, `to ${((most * k) / steps).toPrecision(2)} m`);
      key.style.setProperty("--key", `var(--ramp-${k})`);
    }
  }

  private drawColoured(map: MapView, context: CanvasRenderingContext2D): void {
    const most = this.largest(this.data.runs);
    context.lineWidth = 3;
    for (const [run] of this.shown()) {
      const [from, to] = part(run, this.view);
      const stepOf = (i: number) => Math.min(1 + Math.floor((steps * Math.abs(run[this.component][i]!)) / most), steps);
      for (let i = from; i + 1 < to; ) {
        const step = stepOf(i);
        const begin = i;
        while (i + 1 < to && stepOf(i) === step) ++i;
        context.strokeStyle = ink(`ramp-${step}`);
        map.stroke(run.x.slice(begin, i + 1), run.y.slice(begin, i + 1));
      }
    }
  }

  private drawMarkers(map: MapView, context: CanvasRenderingContext2D): void {
    if (this.isColoured) this.drawColoured(map, context);
    const tracks: [Track, string][] = [[this.data.truth, "truth"], ...this.shown()];
    for (const [track, token] of tracks) {
      context.beginPath();
      const at = (list: number[]) => between(track.time, list, this.view.at);
      context.arc(map.x(at(track.x)), map.y(at(track.y)), 6, 0, 2 * Math.PI);
      context.fillStyle = ink(token);
      context.strokeStyle = ink("surface");
      context.lineWidth = 2;
      context.fill();
      context.stroke();
    }
  }

  // Of the pose under the pointer, if there is one near it.
  private timeAt(x: number, y: number): number | undefined {
    let [best, time] = [20, undefined as number | undefined]; // px
    for (const track of [this.data.truth, ...this.shown().map(([run]) => run)]) {
      const [from, to] = part(track, this.view);
      for (let i = from; i < to; ++i) {
        const apart = Math.hypot(this.map.x(track.x[i]!) - x, this.map.y(track.y[i]!) - y);
        if (apart < best) [best, time] = [apart, track.time[i]!];
      }
    }
    return time;
  }
}
