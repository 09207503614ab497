// The satellites of a GNSS receiver: where they were, when each was used, how strong and how fitting they were.
import type uPlot from "uplot";

import { axis, drawChart } from "./chart";
import { quantities, type Quantity, type Satellite, type Satellites } from "./gnss_data";
import { button, choice, element, figureIn, region, table } from "./dom";
import { linkedChart } from "./linked_charts";
import { ink, onColours } from "./palette";
import { drawSatellite, drawSky } from "./sky";
import type { Timeline } from "./timeline";

const systems: Record<string, string> = {
  G: "GPS", R: "GLONASS", E: "Galileo", C: "BeiDou", J: "QZSS", S: "SBAS", I: "NavIC",
};
const letters = Object.keys(systems);
// How a satellite was used; not by the colour alone, but also by how thick its bar is.
const uses = [
  { text: "used, integer ambiguity", token: "series-6", thick: 0.9 },
  { text: "used", token: "good", thick: 0.6 },
  { text: "in part: code or phase alone", token: "warning", thick: 0.6 },
  { text: "not used", token: "error", thick: 0.25 },
] as const;

const shown: Record<Quantity, { title: string; unit: string; scale: number }> = {
  cn0: { title: "C/N0", unit: "dB-Hz", scale: 0.1 },
  code: { title: "Residuals of code", unit: "m", scale: 1e-3 },
  phase: { title: "Residuals of phase", unit: "m", scale: 1e-3 },
  ionosphere: { title: "Ionosphere's delay on L1, with biases of codes", unit: "m", scale: 1e-3 },
};

// Points drawn by rectangles: there are too many for uPlot's.
interface Cloud {
  chart: uPlot;
  quantity: Quantity;
  isOverTime: boolean;
  points: { token: string; x: number[]; y: number[] }[]; // for each system
  range: [number, number]; // of y
}

// The colour of the satellite's system.
function tokenOf(name: string): string {
  return `series-${letters.indexOf(name[0]!) + 1}`;
}

export class SatelliteViews {
  private readonly hidden = new Set<string>(); // letters of systems
  private one = ""; // name of the only satellite that is shown
  private readonly present: string[]; // letters
  private readonly clouds: Cloud[] = [];
  private readonly rows: uPlot;
  private readonly sky: HTMLCanvasElement;
  private readonly values: HTMLElement;

  constructor(
    private readonly data: Satellites,
    place: HTMLElement,
    private readonly timeline: Timeline,
  ) {
    place.replaceChildren();
    this.present = letters.filter((letter) => data.list.some((s) => s.name[0] === letter));
    this.addOptions(element("div", place, "", "options"));
    const overview = element("div", place, "", "overview");
    const figure = figureIn(overview, "Sky: rings at 0, 30 and 60 degrees of elevation");
    this.sky = element("canvas", figure, "", "sky") as HTMLCanvasElement;
    this.sky.setAttribute("role", "img");
    this.sky.setAttribute("aria-label", "Ways of the satellites over the sky");
    this.values = region(overview, "Satellites at the cursor", "wide satellites");
    this.rows = this.drawRows(figureIn(place, "When each satellite was used; a mark is a slip of its phase"));
    element("p", place, "Of the stretch of time that is shown; the axes fit 99 % of the points.");
    const plots = element("div", place, "", "plots");
    for (const isOverTime of [false, true])
      for (const quantity of quantities)
        if (data.list.some((s) => s[quantity].some((v) => v !== null))) this.drawCloud(plots, quantity, isOverTime);
    timeline.follow(() => this.follow());
    new ResizeObserver(() => this.showSky()).observe(this.sky);
    onColours(() => this.showSky());
  }

  private addOptions(parent: HTMLElement): void {
    for (const letter of this.present) {
      const toggle = button(parent, systems[letter]!, `Show ${systems[letter]}`, () => {
        if (!this.hidden.delete(letter)) this.hidden.add(letter);
        toggle.setAttribute("aria-pressed", `${!this.hidden.has(letter)}`);
        this.redraw();
      });
      toggle.classList.add("key");
      toggle.style.setProperty("--key", `var(--${tokenOf(letter)})`);
      toggle.setAttribute("aria-pressed", "true");
    }
    const names = this.data.list.map((s): [string, string] => [s.name, s.name]);
    choice(parent, "Satellite", [["all", ""], ...names], "", (name) => ((this.one = name), this.redraw()));
  }

  private isShown({ name }: Satellite): boolean {
    return this.one ? name === this.one : !this.hidden.has(name[0]!);
  }

  private redraw(): void {
    this.rows.redraw(false);
    this.shownStretch = "";
    this.follow();
  }

  private shownStretch = "";

  private follow(): void {
    const { from, to } = this.timeline.view;
    const stretch = `${from} ${to}`;
    if (stretch !== this.shownStretch) for (const cloud of this.clouds) this.fill(cloud);
    this.shownStretch = stretch;
    this.showSky();
    this.showValues();
  }

  // A row for each satellite: a bar while it was measured, in the colour of what was used of it.
  private drawRows(figure: HTMLElement): uPlot {
    const { list } = this.data;
    const legend = element("div", figure, "", "legend");
    for (const { text, token } of uses) element("span", legend, text).style.setProperty("--key", `var(--${token})`);
    const names = { ...axis(""), size: 56, gap: 2, splits: () => list.map((_, i) => i), values: () => list.map((s) => s.name) };
    const plot = {
      title: "When each satellite was used", x_label: "GPS time", y_label: "",
      lines: [{ name: "", x: this.timeline.whole, y: [null, null] }], height: 90 + 14 * list.length,
    };
    const scales = { x: { time: false }, y: { dir: -1 as const, range: [-0.5, list.length - 0.5] as [number, number] } };
    return linkedChart(figure, plot, this.timeline, {
      draw: (chart) => this.drawSpans(chart),
      more: { scales, legend: { show: false }, axes: [axis(plot.x_label, this.timeline.clock), { ...names, filter: undefined, grid: { show: false } }] },
    });
  }

  private drawSpans(chart: uPlot): void {
    const { ctx, bbox } = chart;
    const high = Math.abs(chart.valToPos(1, "y", true) - chart.valToPos(0, "y", true));
    ctx.save();
    ctx.beginPath();
    ctx.rect(bbox.left, bbox.top, bbox.width, bbox.height);
    ctx.clip();
    this.data.list.forEach((s, row) => {
      const middle = chart.valToPos(row, "y", true);
      ctx.globalAlpha = this.isShown(s) ? 1 : 0.15;
      for (const [from, to, state] of s.spans) {
        const left = chart.valToPos(from, "x", true);
        const { token, thick } = uses[Math.min(state, uses.length - 1)]!;
        ctx.fillStyle = ink(token);
        ctx.fillRect(left, middle - (thick * high) / 2, Math.max(chart.valToPos(to, "x", true) - left, 1.5), thick * high);
      }
      ctx.fillStyle = ink("ink");
      for (const [time] of s.slips) ctx.fillRect(chart.valToPos(time, "x", true) - 1, middle - high / 2, 2, high);
    });
    ctx.restore();
  }

  private drawCloud(parent: HTMLElement, quantity: Quantity, isOverTime: boolean): void {
    const { title, unit } = shown[quantity];
    const name = `${title}${isOverTime ? " over time" : " against elevation"}`;
    const figure = figureIn(parent, name);
    const lines = [{ name, x: this.timeline.whole, y: [null, null] }];
    const plot = { title: name, x_label: isOverTime ? "GPS time" : "elevation, degrees", y_label: unit, lines };
    const cloud = { quantity, isOverTime, points: [], range: [0, 1] } as unknown as Cloud;
    const y = { range: () => cloud.range };
    const draw = (chart: uPlot) => this.drawPoints(chart, cloud);
    const x = { time: false, ...(!isOverTime && { range: [0, 90] as [number, number] }) };
    const more = { legend: { show: false }, scales: { x, y } };
    cloud.chart = isOverTime
      ? linkedChart(figure, plot, this.timeline, { draw, more })
      : drawChart(figure, plot, { ...more, hooks: { draw: [draw] } });
    this.clouds.push(cloud);
  }

  private fill(cloud: Cloud): void {
    const { time, list } = this.data;
    const { from, to } = this.timeline.view;
    const { quantity, isOverTime } = cloud;
    cloud.points = this.present.map((letter) => ({ token: tokenOf(letter), x: [], y: [] }));
    for (const s of list) {
      if (!this.isShown(s)) continue;
      const { x, y } = cloud.points[this.present.indexOf(s.name[0]!)]!;
      s.at.forEach((at, i) => {
        const value = s[quantity][i];
        if (value == null || time[at]! < from || time[at]! > to || (!isOverTime && s.elevation[i]! <= 0)) return;
        x.push(isOverTime ? time[at]! : s.elevation[i]! / 10);
        y.push(value * shown[quantity].scale);
      });
    }
    const sorted = Float64Array.from(cloud.points.flatMap((p) => p.y)).sort();
    const [low, high] = [0.005, 0.995].map((share) => sorted[Math.round(share * (sorted.length - 1))] ?? 0) as [number, number];
    const pad = 0.15 * (high - low) || 1;
    cloud.range = [low - pad, high + pad];
    cloud.chart.setScale("y", { min: cloud.range[0], max: cloud.range[1] });
    cloud.chart.redraw(false);
  }

  private drawPoints({ ctx, bbox, scales }: uPlot, { points }: Cloud): void {
    const { left, top, width, height } = bbox;
    const [x0, y0, dx, dy] = [scales["x"]!.min!, scales["y"]!.max!, scales["x"]!.max! - scales["x"]!.min!,
      scales["y"]!.min! - scales["y"]!.max!];
    const size = 2.5 * devicePixelRatio;
    ctx.save();
    ctx.beginPath();
    ctx.rect(left, top, width, height);
    ctx.clip();
    for (const { token, x, y } of points) {
      ctx.fillStyle = ink(token);
      for (let i = 0; i < x.length; ++i)
        ctx.fillRect(left + (width * (x[i]! - x0)) / dx - size / 2, top + (height * (y[i]! - y0)) / dy - size / 2, size, size);
    }
    ctx.restore();
  }

  // The index of a satellite's values at the cursor; -1 where it was not measured.
  private indexAtCursor(s: Satellite): number {
    const { time } = this.data;
    const { at } = this.timeline.view;
    const step = time.length > 1 ? (time[time.length - 1]! - time[0]!) / (time.length - 1) : 1;
    let best = -1;
    let [low, high] = [0, s.at.length - 1];
    while (low <= high) {
      const middle = (low + high) >> 1;
      const apart = time[s.at[middle]!]! - at;
      if (Math.abs(apart) <= step) best = best < 0 || Math.abs(apart) < Math.abs(time[s.at[best]!]! - at) ? middle : best;
      if (apart < 0) low = middle + 1;
      else high = middle - 1;
    }
    return best;
  }

  private showSky(): void {
    const size = this.sky.clientWidth;
    if (size === 0) return;
    const ratio = window.devicePixelRatio || 1;
    const context = this.sky.getContext("2d")!;
    if (this.sky.width !== Math.round(size * ratio)) this.sky.width = this.sky.height = Math.round(size * ratio);
    context.setTransform(ratio, 0, 0, ratio, 0, 0);
    context.clearRect(0, 0, size, size);
    const place = drawSky(context, size);
    const radians = Math.PI / 1800;
    const { time, list } = this.data;
    const { from, to } = this.timeline.view;
    for (const s of list) {
      if (!this.isShown(s)) continue;
      context.strokeStyle = context.fillStyle = ink(tokenOf(s.name));
      context.beginPath();
      let last = -2;
      s.at.forEach((at, i) => {
        if (s.elevation[i]! <= 0 || time[at]! < from || time[at]! > to) return;
        const [x, y] = place(s.azimuth[i]! * radians, s.elevation[i]! * radians);
        if (at > last + 10) context.moveTo(x, y); // it set and rose again
        else context.lineTo(x, y);
        last = at;
      });
      context.stroke();
      const now = this.indexAtCursor(s);
      if (now < 0 || s.elevation[now]! <= 0) continue;
      drawSatellite(context, place(s.azimuth[now]! * radians, s.elevation[now]! * radians), s.name, 5);
    }
  }

  private showValues(): void {
    const { at } = this.timeline.view;
    const { states, list } = this.data;
    const rows = list.flatMap((s) => {
      const i = this.indexAtCursor(s);
      if (i < 0 || !this.isShown(s)) return [];
      const name = document.createElement("span");
      name.className = "key";
      name.textContent = s.name;
      name.style.setProperty("--key", `var(--${tokenOf(s.name)})`);
      const state = s.spans.find(([from, to]) => at >= from && at <= to)?.[2] ?? -1;
      const value = (q: Quantity, digits: number) => (s[q][i] == null ? "–" : (s[q][i]! * shown[q].scale).toFixed(digits));
      const degrees = (tenths: number) => (s.elevation[i] === 0 ? "–" : `${(tenths / 10).toFixed(0)}°`); // no orbit: 0
      return [[name, degrees(s.elevation[i]!), degrees((s.azimuth[i]! + 3600) % 3600), value("cn0", 0),
        value("code", 2), value("phase", 3), value("ionosphere", 2), states[state] ?? "–"]];
    });
    table(this.values, [this.timeline.text(at), "elevation", "azimuth", "dB-Hz", "code, m", "phase, m", "ionosphere, m", "used, or why not"], rows);
  }
}
