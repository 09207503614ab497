// Charts over time and over way with one cursor and one stretch of time.
import type uPlot from "uplot";

import { drawChart } from "./chart";
import { between, components, type Component, type Data } from "./comparison_data";
import { element } from "./dom";
import type { Plot } from "./plot";

export interface View {
  at: number; // time of the cursor
  from: number; // stretch that is shown
  to: number;
}

const names: Record<Component, string> = { absolute: "3-D", horizontal: "horizontal", vertical: "vertical" };

export class LinkedCharts {
  private readonly charts: { chart: uPlot; axis: "time" | "way"; component: Component }[] = [];

  constructor(
    private readonly data: Data,
    private readonly tokens: string[],
    private readonly changed: (view: Partial<View>) => void,
  ) {}

  draw(parent: HTMLElement, component: Component): void {
    for (const axis of ["time", "way"] as const) {
      const figure = element("figure", parent);
      figure.dataset["of"] = `${component}-${axis}`;
      const title = `${names[component]} error over ${axis}`;
      element("figcaption", figure, title[0]!.toUpperCase() + title.slice(1));
      this.charts.push({ chart: this.chartOf(figure, component, axis, title), axis, component });
    }
  }

  // Shows runs, all in the order of the data.
  setVisible(visible: boolean[]): void {
    for (const { chart } of this.charts)
      visible.forEach((show, i) => {
        if (chart.series[i + 1]!.show !== show) chart.setSeries(i + 1, { show });
      });
  }

  show(view: View): void {
    for (const { chart, axis } of this.charts) {
      const [min, max] = [this.place(axis, view.from), this.place(axis, view.to)];
      const { x } = chart.scales as { x: uPlot.Scale };
      if ((x.min !== min || x.max !== max) && max > min) chart.setScale("x", { min, max });
      queueMicrotask(() => this.placeCursor(chart, axis, view.at));
    }
  }

  private place(axis: "time" | "way", time: number): number {
    return axis === "time" ? time : between(this.data.truth.time, this.data.truth.way, time);
  }

  private time(axis: "time" | "way", at: number): number {
    return axis === "time" ? at : between(this.data.truth.way, this.data.truth.time, at);
  }

  private placeCursor(chart: uPlot, axis: "time" | "way", time: number): void {
    const left = chart.valToPos(this.place(axis, time), "x");
    chart.setCursor({ left, top: chart.over.clientHeight / 2 }, false);
  }

  private chartOf(figure: HTMLElement, component: Component, axis: "time" | "way", title: string): uPlot {
    const { truth, runs } = this.data;
    const label = axis === "way" ? "way, m" : truth.has_stamps ? "time, s" : "pose";
    const lines = runs.map((r, i) => ({ name: r.name, x: r[axis], y: r[component], token: this.tokens[i]! }));
    const plot: Plot = { title, x_label: label, y_label: "m", lines };
    return drawChart(figure, plot, {
      legend: { show: false },
      cursor: {
        y: false,
        drag: { x: true, y: false, setScale: false },
        bind: { dblclick: () => () => (this.changed({ from: -Infinity, to: Infinity }), null) },
      },
      hooks: {
        setCursor: [
          (chart) => {
            const { left } = chart.cursor;
            if (left != null && left >= 0) this.changed({ at: this.time(axis, chart.posToVal(left, "x")) });
            else this.changed({}); // the pointer has gone, the cursor stays
          },
        ],
        setSelect: [
          (chart) => {
            const { left, width } = chart.select;
            if (width < 4) return;
            const [from, to] = [left, left + width].map((x) => this.time(axis, chart.posToVal(x, "x"))) as [number, number];
            chart.setSelect({ left: 0, top: 0, width: 0, height: 0 }, false);
            this.changed({ from, to });
          },
        ],
      },
    });
  }
}

export { components, names };
