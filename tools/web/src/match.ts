// The page of `maploop match --html`: the map of a track, and why each fix was matched as it was.
import { button, element, region } from "./dom";
import { ink } from "./palette";
import type { Line, Numbers } from "./plot";
import { nearest } from "./series";
import { TimedMap } from "./timed_map";
import type { Timeline } from "./timeline";

// What the program writes (tools/match/decision_data.cpp): of each fix that was used. Texts are indices of `texts`.
export interface Decisions {
  time: number[]; // s
  x: number[]; // m east, as all places
  y: number[]; // m north
  matched_x: Numbers;
  matched_y: Numbers;
  p: Numbers;
  phase: number[];
  explanation: number[];
  candidates: Candidate[][];
  roads: Line[];
  texts: string[];
}

type Candidate = [
  road: number, // in roads
  east: number,
  north: number,
  p: number,
  likelihood: number,
  name: number,
  objections: number[],
  rules: number[],
];

const classes = [
  { name: "probability above 0.9", token: "good", has: (p: number | null) => p !== null && p >= 0.9 },
  { name: "above 0.6", token: "warning", has: (p: number | null) => p !== null && p >= 0.6 && p < 0.9 },
  { name: "less", token: "error", has: (p: number | null) => p !== null && p < 0.6 },
  { name: "on no road", token: "gnss", has: (p: number | null) => p === null },
];

export class MatchViews {
  private readonly map: TimedMap;
  private readonly count: HTMLElement;
  private readonly details: HTMLElement;
  private shown = -1; // index of the fix at the cursor

  constructor(
    private readonly data: Decisions,
    place: HTMLElement,
    private readonly timeline: Timeline,
  ) {
    place.replaceChildren();
    const overview = element("div", place, "", "overview");
    const figure = element("figure", overview, "", "map");
    const legend = element("div", figure, "", "legend");
    for (const { name, token } of [...classes, { name: "matched", token: "matched" }, { name: "candidates", token: "fused" }])
      element("span", legend, name).style.setProperty("--key", `var(--${token})`);
    this.map = new TimedMap(figure, "The track on the road map", timeline);
    this.map.view.roads = data.roads;
    this.map.view.extra = (_, context) => this.drawDecision(context);
    element("small", figure, "Map data © OpenStreetMap contributors", "empty");
    const decision = element("div", overview);
    const steps = element("div", decision, "", "options");
    button(steps, "‹", "The fix before", () => this.step(-1));
    button(steps, "›", "The next fix", () => this.step(1));
    this.count = element("strong", steps);
    this.details = region(decision, "Decision at the cursor", "decision");
    this.map.setTracks(this.tracks());
    timeline.follow(() => this.follow());
  }

  // A track for each class has all times, and places only where the fix is of the class.
  private tracks(): Line[] {
    const { time, x, y, p, matched_x, matched_y } = this.data;
    const only = (has: (p: number | null) => boolean, list: number[]) => list.map((v, i) => (has(p[i]!) ? v : null));
    const fixes = classes.map(({ name, token, has }): Line => ({ name, token, time, x: only(has, x), y: only(has, y), look: "points" }));
    return [{ name: "matched", time, x: matched_x, y: matched_y, opacity: 0.5 }, ...fixes];
  }

  private step(by: number): void {
    const { time } = this.data;
    const at = time[Math.min(Math.max(this.shown + by, 0), time.length - 1)]!;
    this.timeline.goTo({ from: at, to: at });
  }

  private follow(): void {
    const i = nearest(this.data.time, this.timeline.view.at);
    if (i === this.shown) return;
    this.shown = i;
    this.describe();
  }

  private drawDecision(context: CanvasRenderingContext2D): void {
    const { view } = this.map;
    const { candidates, roads, x, y, matched_x, matched_y } = this.data;
    const i = this.shown;
    context.strokeStyle = ink("fused");
    for (const [road, east, north, p] of [...(candidates[i] ?? [])].reverse()) {
      context.globalAlpha = 0.2 + 0.7 * p;
      context.lineWidth = 5;
      view.stroke(roads[road]!.x, roads[road]!.y);
      context.lineWidth = 2;
      context.beginPath();
      context.arc(view.x(east), view.y(north), 3, 0, 2 * Math.PI);
      context.stroke();
    }
    context.globalAlpha = 1;
    context.strokeStyle = ink("ink");
    context.lineWidth = 1.5;
    if (i >= 0 && matched_x[i] != null) view.stroke([x[i]!, matched_x[i]!], [y[i]!, matched_y[i]!]);
    this.map.drawMarkers(context);
  }

  private describe(): void {
    const { time, phase, explanation, candidates, texts } = this.data;
    const i = this.shown;
    this.count.textContent = `Fix ${i + 1} of ${time.length}, ${this.timeline.text(time[i]!)}, ${texts[phase[i]!]}`;
    this.details.replaceChildren();
    element("p", this.details, texts[explanation[i]!]!);
    const table = element("table", this.details);
    const heading = element("tr", table);
    for (const name of ["candidate", "P", "rules"]) element("th", heading, name);
    for (const [, , , p, likelihood, name, objections, rules] of candidates[i]!) {
      const row = element("tr", table);
      const road = element("td", row, texts[name]!);
      if (objections.length > 0) element("div", road, objections.map((k) => texts[k]).join("; "), "error");
      for (const k of rules) element("div", road, texts[k]!, "rule");
      element("td", row, p.toFixed(3));
      element("td", row, likelihood.toFixed(0));
    }
    this.details.scrollTop = 0;
  }
}
