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
