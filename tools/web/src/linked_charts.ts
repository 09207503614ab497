// Charts with the cursor and the stretch of time of a timeline.
import type uPlot from "uplot";

import { drawChart } from "./chart";
import { ink } from "./palette";
import type { Plot } from "./plot";
import { levelTokens, type Timeline } from "./timeline";

// Where a time is on the axis of a chart, such as the way driven until then.
export interface Axis {
  place(time: number): number;
  time(place: number): number;
}

const overTime: Axis = { place: (time) => time, time: (place) => place };

function drawEvents(chart: uPlot, timeline: Timeline): void {
  const { ctx, bbox } = chart;
  ctx.save();
  ctx.beginPath();
  ctx.rect(bbox.left, bbox.top, bbox.width, bbox.height);
  ctx.clip();
  ctx.globalAlpha = 0.18;
  for (const { from, to, level } of timeline.events) {
    const left = chart.valToPos(from, "x", true);
    ctx.fillStyle = ink(levelTokens[level]);
    ctx.fillRect(left, bbox.top, Math.max(chart.valToPos(to, "x", true) - left, 2), bbox.height);
  }
  ctx.restore();
}

// Draws a chart in the figure. Drag across to look at a part of the time; a double click shows all of it. `draw` adds
// to what is drawn.
export function linkedChart(
  figure: HTMLElement,
  plot: Plot,
  timeline: Timeline,
  { axis = overTime, draw, more = {} }: { axis?: Axis; draw?: (chart: uPlot) => void; more?: Partial<uPlot.Options> } = {},
): uPlot {
  const isTime = axis === overTime;
  const shown = isTime && timeline.clock ? { ...plot, x_text: timeline.clock } : plot;
  const chart = drawChart(figure, shown, {
    cursor: {
      y: false,
      drag: { x: true, y: false, setScale: false },
      bind: { dblclick: () => () => (timeline.all(), null) },
    },
    hooks: {
      drawClear: isTime && timeline.events.length > 0 ? [(c) => drawEvents(c, timeline)] : [],
      draw: draw ? [draw] : [],
      setCursor: [
        (c) => {
          const { left } = c.cursor;
          if (left != null && left >= 0) timeline.change({ at: axis.time(c.posToVal(left, "x")) });
          else timeline.change({}); // the pointer has gone, the cursor stays
        },
      ],
      setSelect: [
        (c) => {
          const { left, width } = c.select;
          if (width < 4) return;
          const [from, to] = [left, left + width].map((x) => axis.time(c.posToVal(x, "x"))) as [number, number];
          c.setSelect({ left: 0, top: 0, width: 0, height: 0 }, false);
          timeline.change({ from, to });
        },
      ],
    },
    ...more,
  });
  timeline.follow((view) => {
    const [min, max] = [axis.place(view.from), axis.place(view.to)];
    const { x } = chart.scales as { x: uPlot.Scale };
    if ((x.min !== min || x.max !== max) && max > min) chart.setScale("x", { min, max });
    queueMicrotask(() => {
      const left = chart.valToPos(axis.place(view.at), "x");
      chart.setCursor({ left, top: chart.over.clientHeight / 2 }, false);
    });
  });
  return chart;
}
