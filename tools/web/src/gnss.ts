// Where a GNSS receiver was: positions of one solution relative to another one, the truth or their mean.
import type uPlot from "uplot";

import { statuses, type Solutions } from "./gnss_data";
import { choice, element, figureIn, region, table } from "./dom";
import { linkedChart } from "./linked_charts";
import type { Line, Numbers } from "./plot";
import { figure, type Readout } from "./readout";
import { nearest } from "./series";
import type { Timeline } from "./timeline";

type Vector = [number, number, number];

const axes = ["East", "North", "Up"] as const;
const e2 = 6.69437999014e-3; // of WGS84

// A difference of earth-fixed positions as east, north, up of the place `p`.
function local([x, y, z]: Vector, p: Vector): Vector {
  const [nx, ny, nz] = [p[0], p[1], p[2] / (1 - e2)]; // the ellipsoid's normal, but for its length
  const level = Math.hypot(nx, ny);
  const length = Math.hypot(level, nz);
  const [sf, cf, sl, cl] = [nz / length, level / length, ny / level, nx / level];
  return [-sl * x + cl * y, -sf * cl * x - sf * sl * y + cf * z, cf * cl * x + cf * sl * y + sf * z];
}

export class Positions {
  private of = 0; // index of a track
  private minus: number; // the same; -1: its mean
  private readonly charts: uPlot[] = [];
  private values: [Numbers, Numbers, Numbers] = [[], [], []];
  private limit = 0; // of the charts, m; 0: none
  private readonly statistics: HTMLElement;
  private readonly present: number[]; // statuses that are there

  constructor(
    private readonly data: Solutions,
    place: HTMLElement,
    private readonly timeline: Timeline,
    readout: Readout,
  ) {
    place.replaceChildren();
    const { tracks } = data;
    this.minus = tracks.findIndex((t) => t.name === "truth");
    this.present = [1, 2, 3].filter((s) => data.status.includes(`${s}`));
    const options = element("div", place, "", "options");
    const names = tracks.map((t, i): [string, number] => [t.name, i]);
    const redraw = () => this.redraw();
    if (names.length > 1) choice(options, "Position of", names, this.of, (i) => ((this.of = i), redraw()));
    choice(options, "minus", [["its mean", -1], ...names], this.minus, (i) => ((this.minus = i), redraw()));
    const limits: [string, number][] = [["all", 0], ...[0.05, 0.2, 1, 5, 20].map((m): [string, number] => [`±${m} m`, m])];
    choice(options, "Scale", limits, this.limit, (m) => ((this.limit = m), redraw()));
    this.compute();
    const plots = element("div", place, "", "plots");
    axes.forEach((axis, k) => this.draw(figureIn(plots, axis), axis, k));
    this.statistics = region(place, "Mean and spread", "wide");
    timeline.follow(() => this.showStatistics());
    readout.add("Position", (at) => statuses[Number(data.status[nearest(data.time, at)])]!);
    axes.forEach((axis, k) =>
      readout.add(`${axis}, m`, (at) => {
        const i = nearest(data.time, at);
        return `${figure(this.values[k]![i])} ± ${figure(this.of === 0 ? data.sigma[k]![i] : null)}`;
      }));
  }

  private compute(): void {
    const { tracks, origin } = this.data;
    const of = tracks[this.of]!;
    const other = tracks[this.minus];
    const mean = [of.x, of.y, of.z].map((list) => {
      const known = list.filter((v): v is number => v !== null);
      return known.reduce((sum, v) => sum + v, 0) / Math.max(known.length, 1);
    }) as Vector;
    this.values = [[], [], []];
    of.x.forEach((x, i) => {
      const from = other ? [other.x[i], other.y[i], other.z[i]] : mean;
      const isKnown = x != null && from[0] != null;
      const [a, b, c] = from as Vector;
      const place: Vector = [origin[0] + a, origin[1] + b, origin[2] + c];
      const enu = isKnown ? local([x - a, of.y[i]! - b, of.z[i]! - c], place) : [null, null, null];
      enu.forEach((v, k) => this.values[k]!.push(v));
    });
  }

  // A line for each status: an epoch ends the line of the status before, so that there is no gap where it changes.
  private lines(k: number): Line[] {
    const { time, status } = this.data;
    const values = this.values[k]!;
    const is = (i: number, s: number) => status[i] === `${s}`;
    return this.present.map((s) => ({
      name: statuses[s]!,
      x: time,
      y: values.map((v, i) => (is(i, s) || (i > 0 && is(i - 1, s)) ? v : null)),
    }));
  }

  // One standard deviation of the run's own solution about it.
  private band(k: number): [Numbers, Numbers] {
    const side = (sign: number) =>
      this.values[k]!.map((v, i) => {
        const sigma = this.data.sigma[k]![i];
        return v == null || sigma == null || this.of !== 0 ? null : v + sign * sigma;
      });
    return [side(-1), side(1)];
  }

  private draw(parent: HTMLElement, axis: string, k: number): void {
    const [low, high] = this.band(k);
    const band = { name: "1 sigma", x: this.data.time, low, high, token: "soft", is_clipped: true };
    const plot = { title: axis, x_label: "GPS time", y_label: "m", lines: this.lines(k), bands: [band] };
    const range = (_: uPlot, low: number | null, high: number | null): [number, number] => {
      if (this.limit > 0) return [-this.limit, this.limit];
      const pad = 0.05 * ((high ?? 1) - (low ?? 0)) || 1;
      return [(low ?? 0) - pad, (high ?? 1) + pad];
    };
    const scales = { x: { time: false }, y: { range } };
    this.charts.push(linkedChart(parent, plot, this.timeline, { more: { scales } }));
  }

  private redraw(): void {
    this.compute();
    this.charts.forEach((chart, k) => {
      const columns = [this.data.time, ...this.band(k), ...this.lines(k).map((line) => line.y)];
      chart.setData(columns as uPlot.AlignedData, false);
      chart.redraw(true, true);
      const { from, to } = this.timeline.view;
      chart.setScale("x", { min: from, max: to });
    });
    this.timeline.change({});
  }

  private showStatistics(): void {
    const { time } = this.data;
    const { from, to } = this.timeline.view;
    const rows = axes.map((axis, k) => {
      const known = this.values[k]!.filter((v, i): v is number => v !== null && time[i]! >= from && time[i]! <= to);
      const mean = (list: number[]) => list.reduce((sum, v) => sum + v, 0) / list.length;
      const [m, square] = [mean(known), mean(known.map((v) => v * v))];
      const sorted = known.map(Math.abs).sort((a, b) => a - b);
      const figures = [m, Math.sqrt(Math.max(0, square - m * m)), Math.sqrt(square), sorted[Math.floor(0.95 * (sorted.length - 1))]];
      return [axis, `${known.length}`, ...figures.map((v) => (v === undefined || isNaN(v) ? "–" : v.toFixed(4)))];
    });
    table(this.statistics, ["In the stretch shown", "epochs", "mean, m", "standard deviation, m", "RMS, m", "95 %, m"], rows);
  }
}
