// The table from which a chart of signals is drawn.
import uPlot from "uplot";

import { nearest } from "./series";
import type { Signals } from "./signals";

const most_points = 2000; // of a line: more than a chart has pixels

// The signals' last `span` seconds, thinned to what a chart can show.
export function join(signals: Signals, names: string[], span: number): uPlot.AlignedData {
  const tables = names.map((name): uPlot.AlignedData => {
    const signal = signals.all.get(name);
    if (!signal || signal.seconds.length === 0) return [[], []];
    const begin = nearest(signal.seconds, signals.now - span);
    const step = Math.max(1, Math.ceil((signal.seconds.length - begin) / most_points));
    const pick = (list: number[]) => list.filter((_, i) => i >= begin && (i - begin) % step === 0);
    return [pick(signal.seconds), pick(signal.values)];
  });
  return tables.length === 0 ? [[]] : uPlot.join(tables);
}
