// Live curves of any signals. Which ones they are is in the page's address, so that a link shows the same.
import type uPlot from "uplot";

import { drawChart } from "./chart";
import { join } from "./curve_table";
import { button, choice, element, region } from "./dom";
import { kept, type Signals } from "./signals";

const redrawn_every = 250; // ms
const most_lines = 8;
const usual = [["NAV_STATE/velocity_enu.0", "NAV_STATE/velocity_enu.1"]];

// "a,b;c" of an address: two charts.
function chartsOf(hash: string): string[][] {
  const text = new URLSearchParams(hash.slice(1)).get("curves");
  return text === null ? usual : text.split(";").filter(Boolean).map((names) => names.split(",").slice(0, most_lines));
}

class Curve {
  readonly figure: HTMLElement;
  private chart: uPlot | null = null;

  constructor(parent: HTMLElement, readonly names: string[], private readonly signals: Signals, private readonly curves: Curves) {
    this.figure = element("figure", parent, "", "curve");
    this.figure.addEventListener("dragover", (e) => e.preventDefault());
    this.figure.addEventListener("drop", (e) => {
      e.preventDefault();
      this.add(e.dataTransfer?.getData("text/plain") ?? "");
    });
    this.build();
  }

  add(name: string): void {
    if (!this.signals.all.has(name) || this.names.includes(name) || this.names.length >= most_lines) return;
    this.names.push(name);
    this.changed();
  }

  private changed(): void {
    this.build();
    this.curves.remember();
  }

  // A chart has as many lines as it began with, so another number of them needs another chart.
  private build(): void {
    this.chart?.destroy();
    this.figure.replaceChildren();
    const caption = element("figcaption", this.figure);
    for (const name of this.names)
      button(caption, `${name} ×`, `Remove ${name} from this chart`, () => {
        this.names.splice(this.names.indexOf(name), 1);
        this.changed();
      });
    button(caption, "Remove chart", "Remove this chart", () => this.curves.remove(this));
    const lines = this.names.map((name, i) => ({ name, x: [], y: [], token: `series-${i + 1}` }));
    const plot = { title: this.names.join(", ") || "empty chart", x_label: "s of data", y_label: "", height: 180, lines };
    this.chart = drawChart(this.figure, plot);
    this.draw();
  }

  // The last `span` seconds.
  draw(): void {
    if (this.names.length === 0) return;
    this.chart!.setData(join(this.signals, this.names, this.curves.span), true);
  }
}

export class Curves {
  span = 60; // s
  private frozen = false;
  private readonly list: HTMLElement;
  private readonly tree: HTMLElement;
  private readonly charts: Curve[] = [];
  private shown = ""; // the signals that the tree has

  constructor(parent: HTMLElement, private readonly signals: Signals) {
    const whole = element("details", parent) as HTMLDetailsElement;
    whole.open = location.hash.includes("curves=");
    element("summary", whole, "Curves of any signals");
    const bar = element("div", whole, "", "bar");
    const spans: [string, number][] = [["last 10 s", 10], ["last minute", 60], ["last 10 minutes", kept]];
    choice(bar, "show", spans, this.span, (span) => {
      this.span = span;
      this.draw();
    });
    const freeze = button(bar, "Freeze", "Keep the curves as they are, to look closer: drag across a chart", () => {
      this.frozen = !this.frozen;
      freeze.textContent = this.frozen ? "Go on" : "Freeze";
      this.draw();
    });
    button(bar, "Add a chart", "Add an empty chart, for the next signals", () => {
      this.append([]);
      this.remember();
    });
    const details = element("details", whole);
    element("summary", details, "Signals: press one, or drag it to a chart");
    const filter = element("input", details) as HTMLInputElement;
    filter.placeholder = "text of its name";
    filter.setAttribute("aria-label", "Only signals whose name has");
    filter.addEventListener("input", () => this.fillTree(filter.value));
    this.tree = region(details, "signals", "tree");
    this.list = element("div", whole, "", "charts");
    for (const names of chartsOf(location.hash)) this.append(names);
    setInterval(() => {
      if (!whole.open || document.hidden) return;
      this.fillTree(filter.value);
      if (!this.frozen) this.draw();
    }, redrawn_every);
  }

  remove(curve: Curve): void {
    this.charts.splice(this.charts.indexOf(curve), 1);
    curve.figure.remove();
    this.remember();
  }

  // Puts what is shown into the address.
  remember(): void {
    const curves = this.charts.map((chart) => chart.names.join(",")).join(";");
    const hash = new URLSearchParams(location.hash.slice(1));
    hash.set("curves", curves);
    history.replaceState(null, "", `#${hash}`);
  }

  private append(names: string[]): void {
    this.charts.push(new Curve(this.list, [...names], this.signals, this));
  }

  private draw(): void {
    for (const chart of this.charts) chart.draw();
  }

  private fillTree(filter: string): void {
    const names = [...this.signals.all.keys()].filter((name) => name.toLowerCase().includes(filter.toLowerCase())).sort();
    const shown = names.join();
    if (shown === this.shown) return;
    this.shown = shown;
    const open = new Set([...this.tree.querySelectorAll("details[open]")].map((d) => (d as HTMLElement).dataset["channel"]));
    this.tree.replaceChildren();
    for (const channel of new Set(names.map((name) => name.split("/")[0]!))) {
      const branch = element("details", this.tree) as HTMLDetailsElement;
      branch.dataset["channel"] = channel;
      branch.open = open.has(channel) || filter !== "";
      element("summary", branch, channel);
      for (const name of names.filter((n) => n.startsWith(`${channel}/`))) {
        const leaf = button(branch, name.slice(channel.length + 1), `Show ${name}`, () => {
          if (this.charts.length === 0) this.append([]);
          this.charts[this.charts.length - 1]!.add(name);
        });
        leaf.draggable = true;
        leaf.addEventListener("dragstart", (e) => e.dataTransfer?.setData("text/plain", name));
      }
    }
  }
}
