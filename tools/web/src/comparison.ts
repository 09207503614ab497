// The page of `maploop evaluate` with several runs: what they differ in, and where.
import "../design/tokens.css";
import "../design/base.css";
import "./comparison.css";

import { drawChart } from "./chart";
import { nearest, type Component, type Data } from "./comparison_data";
import { bars, boxes } from "./distributions";
import { button, element, table } from "./dom";
import { components, LinkedCharts, names, type View } from "./linked_charts";
import { themeSwitch } from "./palette";
import { Plane } from "./plane";

function figureIn(parent: HTMLElement, title: string): HTMLElement {
  const figure = element("figure", parent);
  element("figcaption", figure, title);
  return figure;
}

class ComparisonPage {
  private readonly tokens: string[];
  private readonly visible: boolean[];
  private readonly view: View;
  private readonly whole: [number, number];
  private readonly plane: Plane;
  private readonly charts: LinkedCharts;
  private readonly slider: HTMLInputElement;
  private readonly readout: HTMLElement;

  constructor(
    private readonly data: Data,
    private readonly place: HTMLElement,
  ) {
    const { time } = data.truth;
    this.whole = [time[0]!, time[time.length - 1]!];
    this.view = { at: this.whole[0], from: this.whole[0], to: this.whole[1] };
    this.tokens = data.runs.map((_, i) => `series-${(i % 8) + 1}`);
    this.visible = data.runs.map(() => true);
    place.replaceChildren();
    const controls = element("div", place, "", "controls");
    this.addLegend(element("div", controls, "", "runs"));
    this.slider = this.addTime(element("div", controls, "", "time"));
    this.readout = element("div", controls, "", "wide readout");
    this.readout.tabIndex = 0;
    this.readout.setAttribute("role", "region");
    this.readout.setAttribute("aria-label", "Errors at the cursor");
    const options = element("div", place, "", "options");
    this.plane = new Plane(place, data, this.tokens, (at) => this.change({ at }));
    this.addOptions(options);
    this.charts = new LinkedCharts(data, this.tokens, (change) => this.change(change));
    element("h2", place, "Errors along the drive");
    element("p", place, "Drag across a plot to look at a part of the drive; a double click shows all of it.");
    const plots = element("div", place, "", "plots along");
    for (const component of components) this.charts.draw(plots, component);
    this.drawDistributions();
    this.change({});
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

  private applyVisible(): void {
    this.plane.visible = this.visible;
    this.plane.refresh();
    this.charts.setVisible(this.visible);
    this.data.runs.forEach((run, i) => {
      for (const row of this.place.querySelectorAll<HTMLElement>(".row"))
        if (row.dataset["run"] === run.name) row.hidden = !this.visible[i];
    });
    this.showValues();
  }

  private addTime(parent: HTMLElement): HTMLInputElement {
    const label = element("label", parent, this.data.truth.has_stamps ? "Time" : "Pose");
    const slider = element("input", label) as HTMLInputElement;
    slider.type = "range";
    slider.addEventListener("input", () => this.change({ at: Number(slider.value) }));
    button(parent, "+", "Shorter part of the drive", () => this.zoom(0.5));
    button(parent, "−", "Longer part of the drive", () => this.zoom(2));
    button(parent, "All", "Show the whole drive", () => this.change({ from: -Infinity, to: Infinity }));
    return slider;
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

  private zoom(factor: number): void {
    const half = (factor * (this.view.to - this.view.from)) / 2;
    this.change({ from: this.view.at - half, to: this.view.at + half });
  }

  private change(change: Partial<View>): void {
    const { view, whole } = this;
    Object.assign(view, change);
    const least = (whole[1] - whole[0]) / 1000;
    view.from = Math.min(Math.max(view.from, whole[0]), whole[1] - least);
    view.to = Math.max(Math.min(view.to, whole[1]), view.from + least);
    view.at = Math.min(Math.max(view.at, view.from), view.to);
    this.slider.min = `${view.from}`;
    this.slider.max = `${view.to}`;
    this.slider.step = `${(view.to - view.from) / 1000}`;
    this.slider.value = `${view.at}`;
    this.plane.show(view);
    this.charts.show(view);
    this.showValues();
  }

  private showValues(): void {
    const { truth, runs } = this.data;
    const { at } = this.view;
    const i = nearest(truth.time, at);
    const when = truth.has_stamps ? `${at.toFixed(2)} s` : `pose ${at.toFixed(0)}`;
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
    this.slider.setAttribute("aria-valuetext", when);
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

const text = document.getElementById("comparison-data")?.textContent;
const place = document.getElementById("comparison");
if (text && place) {
  const data = JSON.parse(text) as Data;
  themeSwitch(document.querySelector("main")!);
  new ComparisonPage(data, place);
  addCopies(document.getElementById("copies")!, data.tables);
}
