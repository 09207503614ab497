// Draws the plots of a written page: each figure with data-plot, from the list in the page's own JSON.
import "../design/tokens.css";
import "../design/base.css";
import "./page.css";

import { drawChart } from "./chart";
import { button } from "./dom";
import { MapView } from "./map";
import { themeSwitch, tokensOf } from "./palette";
import type { Plot } from "./plot";

function drawMap(figure: HTMLElement, plot: Plot): void {
  const legend = figure.appendChild(document.createElement("div"));
  legend.className = "legend";
  const tokens = tokensOf(plot.lines.map((line) => line.name));
  plot.lines.forEach((line, i) => {
    const key = legend.appendChild(document.createElement("span"));
    key.textContent = line.name;
    key.style.setProperty("--key", `var(--${tokens[i]})`);
  });
  const canvas = figure.appendChild(document.createElement("canvas"));
  canvas.className = "map";
  canvas.setAttribute("role", "img");
  canvas.setAttribute("aria-label", plot.title);
  const map = new MapView(canvas, false);
  map.lines = plot.lines;
  map.roads = plot.roads ?? [];
  map.inMetres = plot.x_label.endsWith(", m");
  const buttons = figure.appendChild(document.createElement("div"));
  buttons.className = "buttons";
  button(buttons, "+", "Nearer", () => map.zoom(1.5));
  button(buttons, "−", "Farther", () => map.zoom(1 / 1.5));
  button(buttons, "⤢", "Show all", () => map.fit());
  map.fit();
}

const data = document.getElementById("plots")?.textContent;
const plots: Plot[] = data ? (JSON.parse(data) as Plot[]) : [];
for (const figure of document.querySelectorAll<HTMLElement>("figure[data-plot]")) {
  const plot = plots[Number(figure.dataset["plot"])];
  if (!plot) continue;
  figure.querySelector(".without")?.remove();
  if (plot.equal_axes) {
    drawMap(figure, plot);
  } else {
    drawChart(figure, plot);
  }
}
themeSwitch(document.body);
