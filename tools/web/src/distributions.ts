// Boxes and bars of errors, made of plain elements so that they follow the page's width and colours.
import type { Bin, Run } from "./comparison_data";
import { element } from "./dom";

function shown(v: number): string {
  return v >= 100 ? v.toFixed(0) : v.toPrecision(3);
}

function part(parent: HTMLElement, kind: string, from: number, to: number, most: number): HTMLElement {
  const e = element("i", parent, "", kind);
  e.style.left = `${(100 * from) / most}%`;
  e.style.width = `${(100 * Math.max(to - from, 0)) / most}%`;
  return e;
}

function row(parent: HTMLElement, run: Run, label: string, token: string): HTMLElement {
  const line = element("div", parent, "", label ? "row" : "row value");
  line.dataset["run"] = run.name;
  line.style.setProperty("--key", `var(--${token})`);
  if (label) element("span", line, label, "key");
  return element("div", line, "", "track");
}

// From the smallest to the 95 % error a line, the middle half a box, the largest a dot.
export function boxes(parent: HTMLElement, runs: Run[], tokens: string[]): void {
  const most = Math.max(...runs.map((r) => r.quantiles[200]!), 1e-9);
  runs.forEach((run, i) => {
    const [low, q1, median, q3, p95, max] = [0, 50, 100, 150, 190, 200].map((k) => run.quantiles[k]!) as [
      number, number, number, number, number, number,
    ];
    const track = row(parent, run, run.name, tokens[i]!);
    part(track, "whisker", low, p95, most);
    part(track, "box", q1, q3, most);
    part(track, "median", median, median, most);
    part(track, "dot", max, max, most);
    const text = `median ${shown(median)} m, middle half ${shown(q1)} to ${shown(q3)} m, 95 % ${shown(p95)} m, largest ${shown(max)} m`;
    element("small", track.parentElement!, text);
  });
}

// For each bin the root mean square error of each run.
export function bars(parent: HTMLElement, runs: Run[], tokens: string[], key: "by_speed" | "by_turn_rate", unit: string): void {
  const edges = new Map<number, Bin>();
  for (const run of runs) for (const bin of run[key]) edges.set(bin.low, bin);
  if (edges.size === 0) {
    element("p", parent, "The truth has no stamps, so its speed and turn rate are not known.", "empty");
    return;
  }
  const most = Math.max(...runs.flatMap((run) => run[key].map((bin) => bin.rmse)), 1e-9);
  for (const low of [...edges.keys()].sort((a, b) => a - b)) {
    const high = edges.get(low)!.high;
    element("h3", parent, high === null ? `from ${low} ${unit}` : `${low} to ${high} ${unit}`);
    runs.forEach((run, i) => {
      const bin = run[key].find((b) => b.low === low);
      if (!bin) return;
      const track = row(parent, run, "", tokens[i]!);
      part(track, "bar-of-run", 0, bin.rmse, most);
      element("small", track.parentElement!, `${shown(bin.rmse)} m, ${bin.poses} poses`);
    });
  }
}
