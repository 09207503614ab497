// Charts of values against time or way, and of distributions.
import {
  Chart,
  Filler,
  Legend,
  LinearScale,
  LineController,
  LineElement,
  LogarithmicScale,
  PointElement,
  Tooltip,
  type ChartDataset,
  type Plugin,
} from "chart.js";

import { colour, type Line, type Numbers, type Plot } from "./plot";

Chart.register(LineController, LineElement, PointElement, LinearScale, LogarithmicScale, Legend, Tooltip, Filler);

const ink = "#808080"; // readable on a light page, on a dark one, and on paper
const grid = "#80808033";

type Point = { x: number; y: number };
type Dataset = ChartDataset<"line", Point[]>;

// A point without a value breaks the line.
function points(x: Numbers, y: Numbers): Point[] {
  return x.map((at, i) => ({ x: at ?? NaN, y: y[i] ?? NaN }));
}

function dataset(line: Line, index: number): Dataset {
  return {
    label: line.name,
    data: points(line.x, line.y),
    borderColor: colour(index),
    backgroundColor: colour(index),
    borderWidth: line.look === "points" ? 0 : 1.6,
    borderDash: line.look === "dashed" ? [5, 4] : [],
    stepped: line.look === "steps" ? "after" : false,
    pointRadius: line.look === "points" ? 2 : 0,
    pointHitRadius: 6,
  };
}

// Two lines; the second one is filled up to the first, which the legend leaves out.
function bands(plot: Plot): Dataset[] {
  return (plot.bands ?? []).flatMap((band, i) => {
    const fill = `${colour(i)}26`;
    const edge = { borderColor: fill, borderWidth: 1, pointRadius: 0, pointHitRadius: 0, order: 1 };
    return [
      { ...edge, label: "", data: points(band.x, band.low) },
      { ...edge, label: band.name, data: points(band.x, band.high), backgroundColor: fill, fill: "-1" },
    ];
  });
}

function mark(plot: Plot): Plugin<"line"> {
  return {
    id: "mark",
    afterDatasetsDraw(chart) {
      if (!plot.x_mark) return;
      const { ctx, chartArea } = chart;
      const at = chart.scales["x"]!.getPixelForValue(plot.x_mark.value);
      if (!(at >= chartArea.left && at <= chartArea.right)) return;
      ctx.save();
      ctx.strokeStyle = ctx.fillStyle = ink;
      ctx.setLineDash([2, 3]);
      ctx.beginPath();
      ctx.moveTo(at, chartArea.top);
      ctx.lineTo(at, chartArea.bottom);
      ctx.stroke();
      ctx.textAlign = at > 0.6 * chartArea.right ? "right" : "left";
      ctx.fillText(plot.x_mark.name, at + (ctx.textAlign === "right" ? -4 : 4), chartArea.top + 10);
      ctx.restore();
    },
  };
}

// 1, 2 and 5 of each decade.
function logarithmicTick(value: number | string): string {
  const v = Number(value);
  const digit = v / 10 ** Math.floor(Math.log10(v) + 1e-9);
  return [1, 2, 5].some((d) => Math.abs(digit - d) < 1e-6) ? `${Number(v.toPrecision(3))}` : "";
}

export function drawChart(figure: HTMLElement, plot: Plot): void {
  const frame = figure.appendChild(document.createElement("div"));
  frame.className = "chart";
  const canvas = frame.appendChild(document.createElement("canvas"));
  canvas.setAttribute("role", "img");
  canvas.setAttribute("aria-label", plot.title);
  const axis = (label: string, log?: boolean) => ({
    type: log ? ("logarithmic" as const) : ("linear" as const),
    title: { display: true, text: label, color: ink },
    ticks: { color: ink, maxRotation: 0, ...(log ? { callback: logarithmicTick } : {}) },
    grid: { color: grid },
    border: { color: ink },
  });
  const first = bands(plot);
  new Chart(canvas, {
    type: "line",
    data: { datasets: [...first, ...plot.lines.map((line, i) => dataset(line, i))] },
    options: {
      animation: false,
      maintainAspectRatio: false,
      parsing: false,
      interaction: { mode: "nearest", axis: "x", intersect: false },
      scales: { x: axis(plot.x_label, plot.x_log), y: axis(plot.y_label, plot.y_log) },
      plugins: {
        legend: {
          labels: { color: ink, boxHeight: 1, boxWidth: 22, filter: (item) => item.text !== "" },
        },
        tooltip: {
          filter: (item) => item.dataset.label !== "" && !first.includes(item.dataset as Dataset),
          callbacks: {
            title: (items) => `${Number(items[0]?.parsed.x).toPrecision(5)}  ${plot.x_label}`,
            label: (item) => `${item.dataset.label}: ${Number(item.parsed.y).toPrecision(4)}`,
          },
        },
      },
    },
    plugins: [mark(plot)],
  });
}

// Paper is narrower than a screen.
window.addEventListener("beforeprint", () => Object.values(Chart.instances).forEach((c) => c.resize()));
