// Charts of values against time or way, and of distributions.
import "uplot/dist/uPlot.min.css";

import uPlot from "uplot";

import { ink, onColours, tokensOf } from "./palette";
import type { Line, Numbers, Plot } from "./plot";

type Table = [number[], ...(number | null)[][]];

// uPlot wants x to increase: points are sorted, and equal ones moved apart by nothing that is seen.
function table(x: Numbers, values: Numbers[], log: [boolean, boolean]): Table {
  const rows: number[] = [];
  for (let i = 0; i < x.length; ++i) if (x[i] != null && !(log[0] && x[i]! <= 0)) rows.push(i);
  rows.sort((a, b) => x[a]! - x[b]! || a - b);
  const span = rows.length > 0 ? x[rows[rows.length - 1]!]! - x[rows[0]!]! : 0;
  let last = -Infinity;
  const moved = rows.map((i) => (last = Math.max(x[i]!, last + Math.max(span, 1e-9) * 1e-9)));
  const shown = (v: number | null | undefined) => (v == null || (log[1] && v <= 0) ? null : v);
  return [moved, ...values.map((list) => rows.map((i) => shown(list[i])))];
}

function seriesOf(line: Line, token: string): uPlot.Series {
  const points = line.look === "points";
  return {
    label: line.name,
    stroke: () => ink(token),
    width: 1.6,
    dash: line.look === "dashed" ? [6, 4] : undefined,
    paths: points ? () => null : line.look === "steps" ? uPlot.paths.stepped!({ align: 1 }) : undefined,
    points: { show: points || line.x.length === 1, size: 4, fill: () => ink(token) },
    value: (_, v) => (v == null ? "–" : `${Number(v.toPrecision(4))}`),
  };
}

// Steps of an axis of seconds that is shown as times of the day.
const timeSteps = [0.1, 0.2, 0.5, 1, 2, 5, 10, 15, 30, 60, 120, 300, 600, 900, 1800, 3600, 7200, 14400, 21600, 43200];

export function axis(label: string, text?: (value: number) => string): uPlot.Axis {
  return {
    ...(text && { incrs: timeSteps, space: 80 }),
    label,
    labelSize: 22,
    labelFont: "12px system-ui",
    font: "12px system-ui",
    stroke: () => ink("soft"),
    grid: { stroke: () => ink("line"), width: 1 },
    ticks: { stroke: () => ink("line"), width: 1 },
    values: (_, ticks) => ticks.map((v) => (v == null ? "" : text ? text(v) : `${Number(v.toPrecision(6))}`)),
  };
}

// 1, 2 and 5 of each decade, or 1 if there are many.
const logarithmic: uPlot.Axis["filter"] = (_, ticks) => {
  const digits = ticks[ticks.length - 1]! / ticks[0]! > 300 ? [1] : [1, 2, 5];
  return ticks.map((v) => (digits.includes(Math.round(v / 10 ** Math.floor(Math.log10(v) + 1e-9))) ? v : null));
};

function drawMark(chart: uPlot, mark: NonNullable<Plot["x_mark"]>): void {
  const { ctx, bbox } = chart;
  const at = chart.valToPos(mark.value, "x", true);
  if (!(at >= bbox.left && at <= bbox.left + bbox.width)) return;
  ctx.save();
  ctx.strokeStyle = ctx.fillStyle = ink("warning");
  ctx.setLineDash([4, 5]);
  ctx.beginPath();
  ctx.moveTo(at, bbox.top);
  ctx.lineTo(at, bbox.top + bbox.height);
  ctx.stroke();
  ctx.font = `${12 * uPlot.pxRatio}px system-ui`;
  ctx.textAlign = at > bbox.left + 0.6 * bbox.width ? "right" : "left";
  ctx.fillText(mark.name, at + (ctx.textAlign === "right" ? -4 : 4), bbox.top + 12 * uPlot.pxRatio);
  ctx.restore();
}

// Draws a chart that is as wide as the figure. `more` adds to uPlot's options.
export function drawChart(figure: HTMLElement, plot: Plot, more: Partial<uPlot.Options> = {}): uPlot {
  const frame = figure.appendChild(document.createElement("div"));
  frame.className = "chart";
  frame.setAttribute("role", "group");
  frame.setAttribute("aria-label", plot.title);
  const log: [boolean, boolean] = [!!plot.x_log, !!plot.y_log];
  const tokens = plot.lines.map((line) => line.token);
  const guessed = tokensOf(plot.lines.map((line) => line.name));
  const tokenOf = (i: number) => tokens[i] ?? guessed[i] ?? "soft";
  const bands = plot.bands ?? [];
  const bandToken = (i: number) => bands[i]!.token ?? tokenOf(i);
  const edges = bands.flatMap((band, i): uPlot.Series[] => {
    const stroke = () => `rgb(from ${ink(bandToken(i))} r g b / 0.3)`;
    const edge = { stroke, width: 1, points: { show: false }, auto: !band.is_clipped };
    const half = (chart: uPlot, high: number | null, k: number, at: number | null) =>
      high == null ? "–" : `± ${Number(((high - chart.data[k - 1]![at!]!) / 2).toPrecision(4))}`;
    return [{ ...edge, label: `${band.name}, low`, class: "unnamed" }, { ...edge, label: band.name, value: half }];
  });
  const tables = [
    ...bands.map((band) => table(band.x, [band.low, band.high], log)),
    ...plot.lines.map((line) => table(line.x, [line.y], log)),
  ];
  const size = () => ({ width: Math.max(figure.clientWidth, 200), height: plot.height ?? 280 });
  const axes = [axis(plot.x_label, plot.x_text), { ...axis(plot.y_label), size: 56 }];
  if (log[0]) axes[0]!.filter = logarithmic;
  if (log[1]) axes[1]!.filter = logarithmic;
  const options: uPlot.Options = {
    ...size(),
    series: [{ label: plot.x_label, value: (_, v) => (v == null ? "–" : plot.x_text ? plot.x_text(v) : `${Number(v.toPrecision(6))}`) }, ...edges,
      ...plot.lines.map((line, i) => seriesOf(line, tokenOf(i)))],
    bands: bands.map((_, i) => ({
      series: [2 * i + 2, 2 * i + 1],
      fill: () => `rgb(from ${ink(bandToken(i))} r g b / 0.15)`,
    })),
    axes,
    scales: { x: { time: false, distr: log[0] ? 3 : 1 }, y: { distr: log[1] ? 3 : 1 } },
    legend: { markers: { width: 0, fill: (_, i) => `var(--${i > edges.length ? tokenOf(i - 1 - edges.length) : bandToken((i - 1) >> 1)})` } },
    plugins: plot.x_mark ? [{ hooks: { draw: (chart) => drawMark(chart, plot.x_mark!) } }] : [],
    ...more,
  };
  const data = tables.length > 0 ? uPlot.join(tables as uPlot.AlignedData[]) : ([[]] as unknown as uPlot.AlignedData);
  const chart = new uPlot(options, data, frame);
  new ResizeObserver(() => chart.setSize(size())).observe(figure);
  onColours(() => chart.redraw(false));
  return chart;
}
