// What the program writes into a page (tools/web/plot.h), and what charts and maps are drawn from.

export type Numbers = (number | null)[];

export interface Line {
  name: string;
  x: Numbers;
  y: Numbers;
  look?: "dashed" | "steps" | "points";
}

export interface Band {
  name: string;
  x: Numbers;
  low: Numbers;
  high: Numbers;
}

export interface Plot {
  title: string;
  x_label: string;
  y_label: string;
  lines: Line[];
  bands?: Band[];
  roads?: Line[]; // beneath the lines of a map
  equal_axes?: boolean;
  x_log?: boolean;
  y_log?: boolean;
  x_mark?: { value: number; name: string };
}

// Told apart by people who do not see all colours, on white and on black.
const colours = ["#2a78d6", "#e34948", "#1baf7a", "#eda100", "#8a5cd0", "#17a2b8", "#e87ba4", "#8c6d31"];

export function colour(index: number): string {
  return colours[index % colours.length]!;
}
