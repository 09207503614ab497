// What `maploop evaluate` writes into the page of a comparison (tools/evaluate/comparison_page.cpp).

export interface Bin {
  low: number;
  high: number | null; // the last one has no end
  rmse: number;
  p95: number;
  poses: number;
}

export interface Track {
  name: string;
  time: number[]; // s, or poses without stamps
  way: number[]; // m, along the truth
  x: number[]; // m, from the truth's first position
  y: number[];
}

export const components = ["absolute", "horizontal", "vertical"] as const;
export type Component = (typeof components)[number];

export interface Run extends Track, Record<Component, number[]> {
  poses: number;
  quantiles: number[]; // of the absolute error, 0 to 100 % by halves
  relative: [number, number][]; // length in m, error in %
  by_speed: Bin[]; // km/h
  by_turn_rate: Bin[]; // deg/s
}

export interface Data {
  truth: Track & { has_stamps: boolean };
  runs: Run[];
  tables: Record<"csv" | "markdown" | "latex", string>;
}

// The index of the value nearest to `at` in an increasing list.
export function nearest(list: number[], at: number): number {
  let [low, high] = [0, list.length - 1];
  while (high - low > 1) {
    const middle = (low + high) >> 1;
    if (list[middle]! <= at) low = middle;
    else high = middle;
  }
  return at - list[low]! < list[high]! - at ? low : high;
}

// The value of `to` where `from`, which increases, is `at`.
export function between(from: number[], to: number[], at: number): number {
  const i = nearest(from, at);
  const j = Math.min(Math.max(at >= from[i]! ? i + 1 : i - 1, 0), from.length - 1);
  const span = from[j]! - from[i]!;
  const share = span === 0 ? 0 : Math.min(Math.max((at - from[i]!) / span, 0), 1);
  return to[i]! + share * (to[j]! - to[i]!);
}
