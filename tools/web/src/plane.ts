// The runs and the truth seen from above, with where they are at the cursor.
import type { Component, Data, Run } from "./comparison_data";
import { element } from "./dom";
import { ink } from "./palette";
import { TimedMap } from "./timed_map";
import type { Timeline } from "./timeline";

const steps = 5; // of the ramp of colours

export class Plane {
  visible: boolean[];
  isColoured = false;
  component: Component = "absolute";

  private readonly map: TimedMap;
  private readonly scale: HTMLElement;

  constructor(
    parent: HTMLElement,
    private readonly data: Data,
    private readonly tokens: string[],
    timeline: Timeline,
  ) {
    this.visible = data.runs.map(() => true);
    const figure = element("figure", parent, "", "map");
    element("figcaption", figure, "Seen from above, the truth beneath");
    this.map = new TimedMap(figure, "Trajectories seen from above", timeline);
    this.map.view.extra = (_, context) => {
      if (this.isColoured) this.drawColoured(context);
      this.map.drawMarkers(context);
    };
    this.scale = element("div", figure, "", "legend");
    this.refresh();
  }

  // After a change of what is shown.
  refresh(): void {
    const { truth, runs } = this.data;
    const opacity = this.isColoured ? 0 : 1;
    this.map.setTracks([
      { ...truth, token: "truth", width: 7, opacity: 0.35 },
      ...this.shown().map(([run, token]) => ({ ...run, token, width: 2, opacity })),
    ]);
    this.showScale(runs);
  }

  private shown(): [Run, string][] {
    return this.data.runs.flatMap((run, i) => (this.visible[i] ? [[run, this.tokens[i]!] as [Run, string]] : []));
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

  private drawColoured(context: CanvasRenderingContext2D): void {
    const most = this.largest(this.data.runs);
    context.lineWidth = 3;
    for (const [run] of this.shown()) {
      const [from, to] = this.map.part(run);
      const stepOf = (i: number) => Math.min(1 + Math.floor((steps * Math.abs(run[this.component][i]!)) / most), steps);
      for (let i = from; i + 1 < to; ) {
        const step = stepOf(i);
        const begin = i;
        while (i + 1 < to && stepOf(i) === step) ++i;
        context.strokeStyle = ink(`ramp-${step}`);
        this.map.view.stroke(run.x.slice(begin, i + 1), run.y.slice(begin, i + 1));
      }
    }
  }
}
