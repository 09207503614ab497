// A table of what the pictures show at the cursor.
import { region, table } from "./dom";
import { nearest } from "./series";
import type { Plot } from "./plot";
import type { Timeline } from "./timeline";

export function figure(value: number | null | undefined): string {
  return value == null ? "–" : `${Number(value.toPrecision(4))}`;
}

export class Readout {
  private readonly rows: { name: string; text: (time: number) => string }[] = [];

  constructor(place: HTMLElement, timeline: Timeline) {
    place.replaceChildren();
    const body = region(place, "Values at the cursor", "wide");
    timeline.follow(({ at }) => table(body, ["", timeline.text(at)], this.rows.map((row) => [row.name, row.text(at)])));
  }

  add(name: string, text: (time: number) => string): void {
    this.rows.push({ name, text });
  }

  // The values of a plot over time; those of a band are half its width.
  addPlot({ title, y_label, lines, bands = [] }: Plot): void {
    const values = (x: (number | null)[], at: number, value: (i: number) => number | null | undefined, name: string) => {
      const v = x.length > 0 ? value(nearest(x as number[], at)) : null;
      return v == null ? [] : [`${name} ${figure(v)}`];
    };
    this.add(`${title}, ${y_label}`, (at) => {
      const parts = [
        ...lines.flatMap((line) => values(line.x, at, (i) => line.y[i], line.name)),
        ...bands.flatMap((band) =>
          values(band.x, at, (i) => (band.high[i] == null ? null : (band.high[i]! - band.low[i]!) / 2), `${band.name} ±`)),
      ];
      return parts.join(", ") || "–";
    });
  }
}
