// Draws the pictures of a written page: each figure with data-plot, from the list in the page's own JSON, and what has a
// place of its own. Pictures over time have one cursor.
import "../design/tokens.css";
import "../design/base.css";
import "./page.css";

import { drawChart } from "./chart";
import { showComparison } from "./comparison";
import type { Data } from "./comparison_data";
import { element } from "./dom";
import { Positions } from "./gnss";
import type { Satellites, Solutions } from "./gnss_data";
import { linkedChart } from "./linked_charts";
import { MatchViews, type Decisions } from "./match";
import { linkMoments } from "./moments";
import { themeSwitch, tokensOf } from "./palette";
import type { Plot } from "./plot";
import { Readout } from "./readout";
import { SatelliteViews } from "./satellites";
import type { Trace } from "./tick_data";
import { showTicks } from "./ticks";
import { TimedMap } from "./timed_map";
import { clockFrom, seconds, Timeline, type TimelineEvent } from "./timeline";

function dataOf<T>(id: string): T | undefined {
  const text = document.getElementById(id)?.textContent;
  return text ? (JSON.parse(text) as T) : undefined;
}

// Draws what has a place on this page and data in it.
function show<T>(id: string, draw: (place: HTMLElement, data: T) => void): void {
  const [place, data] = [document.getElementById(id), dataOf<T>(`${id}-data`)];
  if (place && data) draw(place, data);
}

function drawMap(figure: HTMLElement, plot: Plot, timeline?: Timeline): void {
  const legend = element("div", figure, "", "legend");
  const tokens = tokensOf(plot.lines.map((line) => line.name));
  plot.lines.forEach((line, i) => element("span", legend, line.name).style.setProperty("--key", `var(--${tokens[i]})`));
  const map = new TimedMap(figure, plot.title, timeline);
  map.view.roads = plot.roads ?? [];
  map.view.inMetres = plot.x_label.endsWith(", m");
  const beneath = { width: 7, opacity: 0.35 }; // of the others, so that both are seen
  const isBeneath = (name: string) => name === "truth" && plot.lines.length > 1;
  map.setTracks(plot.lines.map((line) => (isBeneath(line.name) ? { ...line, ...beneath } : line)));
}

const nextTask = () => new Promise((resolve) => setTimeout(resolve));

// One picture after the other, so that the first ones are there at once.
async function drawAll(plots: Plot[], timeline?: Timeline, readout?: Readout): Promise<void> {
  for (const figure of document.querySelectorAll<HTMLElement>("figure[data-plot]")) {
    const plot = plots[Number(figure.dataset["plot"])];
    if (!plot) continue;
    figure.querySelector(".without")?.remove();
    if (plot.equal_axes) drawMap(figure, plot, timeline);
    else if (plot.over_time && timeline) linkedChart(figure, plot, timeline);
    else drawChart(figure, plot);
    if (plot.over_time && plot.in_readout) readout?.addPlot(plot);
    await nextTask();
  }
}

// The time that all pictures over time cover, a second at least; nothing if there is none.
function wholeTime(plots: Plot[]): [number, number] | undefined {
  let [first, last] = [Infinity, -Infinity];
  for (const { over_time, lines, bands = [] } of plots)
    for (const { x } of over_time ? [...lines, ...bands] : [])
      for (const end of [x[0], x[x.length - 1]])
        if (end != null) [first, last] = [Math.min(first, end), Math.max(last, end)];
  return first <= last ? [first, Math.max(last, first + 1)] : undefined;
}

async function drawPage(): Promise<void> {
  themeSwitch(document.querySelector("main")!);
  show<Data>("comparison", showComparison);
  show<Trace>("ticks", showTicks);
  const plots = dataOf<Plot[]>("plots") ?? [];
  const whole = wholeTime(plots);
  let timeline: Timeline | undefined;
  show<{ start: number | null; events: TimelineEvent[] }>("timeline", (place, { start, events }) => {
    place.replaceChildren();
    place.className = "controls";
    if (!whole) return;
    const clock = start === null ? undefined : clockFrom(start);
    timeline = new Timeline(whole, clock ?? seconds, events, clock);
    timeline.addControls(place, "Time");
    timeline.addEvents(document.getElementById("events")!);
  });
  if (!timeline) return drawAll(plots);
  linkMoments(timeline);
  show<Decisions>("match", (place, data) => new MatchViews(data, place, timeline!));
  const values = document.getElementById("readout");
  const readout = values ? new Readout(values, timeline) : undefined;
  show<Solutions>("positions", (place, data) => new Positions(data, place, timeline!, readout!));
  await drawAll(plots, timeline, readout);
  show<Satellites>("satellites", (place, data) => new SatelliteViews(data, place, timeline!));
  timeline.change({});
}

void drawPage();
