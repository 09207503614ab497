// The comparison of runs by `maploop evaluate`: what they differ in, and where.
import type uPlot from "uplot";

import { drawChart } from "./chart";
import { components, type Component, type Data, type Run } from "./comparison_data";
import { bars, boxes } from "./distributions";
import { button, element, figureIn, region, table } from "./dom";
import { linkedChart, type Axis } from "./linked_charts";
import { Plane } from "./plane";
import { between, nearest } from "./series";
import { Timeline } from "./timeline";

const names: Record<Component, string> = { absolute: "3-D", horizontal: "horizontal", vertical: "vertical" };

class ComparisonPage {
  private readonly tokens: string[];
  private readonly visible: boolean[];
  private readonly timeline: Timeline;
  private readonly plane: Plane;
  private readonly charts: uPlot[] = [];
  private readonly readout: HTMLElement;

  constructor(
    private readonly data: Data,
    private readonly place: HTMLElement,
  ) {
    const { time, has_stamps } = data.truth;
    const text = (at: number) => (has_stamps ? `${at.toFixed(2)} s` : `pose ${at.toFixed(0)}`);
    this.timeline = new Timeline([time[0]!, time[time.length - 1]!], text);
    this.tokens = data.runs.map((_, i) => `series-${(i % 8) + 1}`);
    this.visible = data.runs.map(() => true);
    place.replaceChildren();
    const controls = element("div", place, "", "controls");
    this.addLegend(element("div", controls, "", "runs"));
    this.timeline.addControls(controls, has_stamps ? "Time" : "Pose");
    this.readout = region(controls, "Errors at the cursor", "wide readout");
    this.addRanking(element("ol", place));
    const options = element("div", place, "", "options");
    this.plane = new Plane(place, data, this.tokens, this.timeline);
    this.addOptions(options);
    element("h2", place, "Errors along the drive");
    element("p", place, "Drag across a plot to look at a part of the drive; a double click shows all of it.");
    const plots = element("div", place, "", "plots along");
    for (const component of components) this.drawErrors(plots, component);
    this.drawDistributions();
    this.timeline.follow(() => this.showValues());
  }

  private addLegend(parent: HTMLElement): void {
    const truth = element("span", parent, `truth: ${this.data.truth.name}`, "key");
    truth.style.setProperty("--key", "var(--truth)");
    this.data.runs.forEach((run, i) => {
      const toggle = button(parent, run.name, `Show ${run.name}`, () => {
        this.visible[i] = !this.visible[i];
        toggle.setAttribute("aria-pressed", `${this.visible[i]}`);
        this.applyVisible();
      });
      toggle.classList.add("key");
      toggle.style.setProperty("--key", `var(--${this.tokens[i]})`);
      toggle.setAttribute("aria-pressed", "true");
    });
  }

  // The best run first.
  private addRanking(parent: HTMLElement): void {
    const of = ({ quantiles }: Run, percent: number) => `${quantiles[2 * percent]!.toFixed(3)} m`;
    for (const run of [...this.data.runs].sort((a, b) => a.quantiles[100]! - b.quantiles[100]!)) {
      const item = element("li", parent, `${run.name}: median 3-D error ${of(run, 50)}, 95 % within ${of(run, 95)}, `);
      const largest = run.absolute.indexOf(run.absolute.reduce((most, v) => Math.max(most, v)));
      const at = run.time[largest]!;
      button(item, `largest ${of(run, 100)}`, "Move the cursor there", () => this.timeline.goTo({ from: at, to: at }));
    }
  }

  private applyVisible(): void {
    this.plane.visible = this.visible;
    this.plane.refresh();
    for (const chart of this.charts)
      this.visible.forEach((show, i) => {
        if (chart.series[i + 1]!.show !== show) chart.setSeries(i + 1, { show });
      });
    this.data.runs.forEach((run, i) => {
      for (const row of this.place.querySelectorAll<HTMLElement>(".row"))
        if (row.dataset["run"] === run.name) row.hidden = !this.visible[i];
    });
    this.showValues();
  }

  private drawErrors(parent: HTMLElement, component: Component): void {
    const { truth, runs } = this.data;
    const overWay: Axis = {
      place: (time) => between(truth.time, truth.way, time)!,
      time: (way) => between(truth.way, truth.time, way)!,
    };
    for (const axis of ["time", "way"] as const) {
      const title = `${names[component]} error over ${axis}`;
      const figure = figureIn(parent, title[0]!.toUpperCase() + title.slice(1));
      figure.dataset["of"] = `${component}-${axis}`;
      const x_label = axis === "way" ? "way, m" : truth.has_stamps ? "time, s" : "pose";
      const lines = runs.map((r, i) => ({ name: r.name, x: r[axis], y: r[component], token: this.tokens[i]! }));
      const options = { more: { legend: { show: false } }, ...(axis === "way" && { axis: overWay }) };
      this.charts.push(linkedChart(figure, { title, x_label, y_label: "m", lines }, this.timeline, options));
    }
  }

  private addOptions(parent: HTMLElement): void {
    const label = element("label", parent, "");
    const coloured = element("input", label) as HTMLInputElement;
    coloured.type = "checkbox";
    label.append(" Colour the way (last run on top) by ");
    const choice = element("select", parent) as HTMLSelectElement;
    choice.setAttribute("aria-label", "Error that colours the way");
    for (const component of components) choice.append(new Option(`${names[component]} error`, component));
    const apply = () => {
      this.plane.isColoured = coloured.checked;
      this.plane.component = choice.value as Component;
      this.plane.refresh();
    };
    coloured.addEventListener("change", apply);
    choice.addEventListener("change", apply);
  }

  private showValues(): void {
    const { truth, runs } = this.data;
    const { at } = this.timeline.view;
    const i = nearest(truth.time, at);
    const when = this.timeline.text(at);
    const rows = runs.flatMap((run, k) => {
      if (!this.visible[k]) return [];
      const j = nearest(run.time, at);
      const name = document.createElement("span");
      name.className = "key";
      name.textContent = run.name;
      name.style.setProperty("--key", `var(--${this.tokens[k]})`);
      return [[name, ...components.map((c) => `${run[c][j]!.toFixed(3)} m`)]];
    });
    table(this.readout, [`${when}, ${truth.way[i]!.toFixed(1)} m`, ...components.map((c) => names[c])], rows);
  }

  private drawDistributions(): void {
    const { runs } = this.data;
    element("h2", this.place, "Distribution of the 3-D error");
    element("p", this.place, "Of all poses of the whole drive, whatever part of it is shown above.");
    const plots = element("div", this.place, "", "plots");
    boxes(figureIn(plots, "Box from 25 to 75 %, line to 95 %, dot at the largest"), runs, this.tokens);
    const shares = Array.from({ length: 201 }, (_, i) => i / 2);
    const cumulative = figureIn(plots, "Share of the poses with at most this error");
    drawChart(cumulative, {
      title: "Cumulative distribution of the error",
      x_label: "3-D error, m",
      y_label: "% of the poses",
      lines: runs.map((r, i) => ({ name: r.name, x: r.quantiles, y: shares, token: this.tokens[i]! })),
    }, { legend: { show: false } });
    bars(figureIn(plots, "Root mean square of the 3-D error by speed"), runs, this.tokens, "by_speed", "km/h");
    bars(figureIn(plots, "Root mean square of the 3-D error by turn rate"), runs, this.tokens, "by_turn_rate", "deg/s");
    const relative = figureIn(plots, "Relative error of segments");
    if (runs.every((run) => run.relative.length === 0)) {
      element("p", relative, "The way is shorter than the shortest segment (--lengths).", "empty");
      return;
    }
    drawChart(relative, {
      title: "Relative error over the length of segments",
      x_label: "length, m",
      y_label: "% of the length",
      lines: runs.map((r, i) => ({
        name: r.name,
        x: r.relative.map(([length]) => length),
        y: r.relative.map(([, percent]) => percent),
        token: this.tokens[i]!,
      })),
    }, { legend: { show: false } });
  }
}

// The table's text in a format, to copy.
function addCopies(parent: HTMLElement, tables: Data["tables"]): void {
  parent.classList.add("copies");
  const text = document.createElement("textarea");
  text.readOnly = true;
  text.rows = 6;
  text.hidden = true;
  text.setAttribute("aria-label", "The table as text");
  const said = document.createElement("span");
  said.setAttribute("role", "status");
  for (const [format, name] of [["csv", "CSV"], ["latex", "LaTeX"], ["markdown", "Markdown"]] as const)
    button(parent, `Copy as ${name}`, `Copy the table as ${name}`, () => {
      text.hidden = false;
      text.value = tables[format];
      text.select();
      const failed = () => (said.textContent = "The browser does not let pages copy: copy it from here.");
      if (!navigator.clipboard) return void failed();
      navigator.clipboard.writeText(text.value).then(() => (said.textContent = `Copied as ${name}.`), failed);
    });
  parent.append(said, text);
}

export function showComparison(place: HTMLElement, data: Data): void {
  new ComparisonPage(data, place);
  addCopies(document.getElementById("copies")!, data.tables);
}
