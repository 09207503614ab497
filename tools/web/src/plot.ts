// What the program writes into a page (tools/web/plot.h), and what charts and maps are drawn from.

export type Numbers = (number | null)[];

export interface Line {
  name: string;
  x: Numbers;
  y: Numbers;
  time?: number[]; // of each place on a map
  look?: "solid" | "dashed" | "steps" | "points";
  token?: string; // of its colour (palette.ts)
  width?: number; // px, on a map
  opacity?: number; // on a map
}

export interface Band {
  name: string;
  x: Numbers;
  low: Numbers;
  high: Numbers;
  token?: string; // else that of the line with its index
  is_clipped?: boolean; // the axis fits the lines alone
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
  over_time?: boolean; // x follows the timeline of the page
  in_readout?: boolean; // its values are in the table at the cursor
  x_text?: (x: number) => string; // else the number
  height?: number; // px
}
