// Any tick of a traced run as a time line: a row for each thread, waits between what ran, the guilty part marked.
import { drawChart } from "./chart";
import { button, choice, element, figureIn, region, table } from "./dom";
import { roundStep } from "./round";
import { length, Ticks, type Part, type Span, type Tick, type Trace } from "./tick_data";

const around = 0.04; // share of the time that is shown before and after
const named_from = 9; // % of the width, so that a name fits
const row_height = 17; // px

export function showTicks(place: HTMLElement, trace: Trace): void {
  const ticks = new Ticks(trace);
  place.replaceChildren();
  if (ticks.kinds.size > 0) new TickView(place, ticks);
  else element("p", place, "The trace has no sample whose state was published: let the run last longer.", "empty");
  if (trace.until) element("p", place, `The page has the first ${(trace.until * 1e-7).toFixed(0)} s of the trace.`);
}

class TickView {
  private kind: string;
  private tick: Tick;
  private readonly bar: HTMLElement;
  private readonly chart: HTMLElement;
  private readonly rows: HTMLElement;
  private readonly parts: HTMLElement;
  private readonly said: HTMLElement;
  private readonly number: HTMLInputElement;
  private readonly time: HTMLInputElement;

  constructor(place: HTMLElement, private readonly ticks: Ticks) {
    const kinds = [...ticks.kinds.keys()].sort();
    this.kind = kinds[0]!;
    this.tick = this.all[0]!;
    this.bar = element("div", place, "", "options");
    choice(this.bar, "of", kinds.map((kind): [string, string] => [kind, kind]), this.kind, (kind) => this.show(kind));
    this.number = this.input("number", (value) => this.select(this.all[Math.round(value)]));
    this.time = this.input("at, s", (value) => this.select(this.nearest(1000 * value)));
    this.addButtons();
    this.said = element("p", place);
    this.said.setAttribute("aria-live", "polite");
    this.rows = region(place, "What each thread did in the tick", "threads");
    this.parts = region(place, "Parts of the tick", "wide");
    this.chart = element("div", place);
    this.show(this.kind);
  }

  private get all(): Tick[] {
    return this.ticks.kinds.get(this.kind)!;
  }

  private input(name: string, act: (value: number) => void): HTMLInputElement {
    const label = element("label", this.bar, `${name} `);
    const input = element("input", label) as HTMLInputElement;
    input.type = "number";
    input.min = "0";
    input.step = name === "number" ? "1" : "any";
    input.addEventListener("change", () => act(input.valueAsNumber));
    return input;
  }

  private addButtons(): void {
    const { bar } = this;
    button(bar, "‹", "The one before", () => this.select(this.all[this.tick.index - 1]));
    button(bar, "›", "The next one", () => this.select(this.all[this.tick.index + 1]));
    const shares: [string, number, string][] = [["p50", 0.5, "Half take longer"], ["p99", 0.99, "One of a hundred takes longer"], ["worst", 1, "The longest"]];
    for (const [name, share, title] of shares)
      button(bar, name, title, () => this.select(this.ticks.atPercentile(this.kind, share)));
    button(bar, "next missed", "The next one with a missed deadline, from the first again after the last", () => {
      const late = this.all.filter((tick) => tick.missed.length > 0);
      const next = late.find((tick) => tick.index > this.tick.index) ?? late[0];
      if (next) this.select(next);
      else this.said.textContent = "None of these missed a deadline in the trace.";
    });
  }

  private nearest(at: number): Tick {
    return this.all.reduce((best, tick) => (Math.abs(tick.from - at) < Math.abs(best.from - at) ? tick : best));
  }

  private show(kind: string): void {
    this.kind = kind;
    this.chart.replaceChildren();
    const x = this.all.map((tick) => tick.from / 1000);
    const y = this.all.map(length);
    const lines = [{ name: kind, x, y, look: "points" as const, token: "fused" }];
    const plot = { title: "Each of them: press one", x_label: "s since the start of the trace", y_label: "ms", height: 200, lines };
    const chart = drawChart(figureIn(this.chart, plot.title), plot);
    chart.over.addEventListener("click", () => this.select(this.all[chart.cursor.idx ?? -1]));
    this.select(this.ticks.atPercentile(kind, 1));
  }

  private select(tick: Tick | undefined): void {
    if (!tick) return;
    this.tick = tick;
    this.number.value = `${tick.index}`;
    this.number.max = `${this.all.length - 1}`;
    this.time.value = (tick.from / 1000).toFixed(3);
    const guilty = this.ticks.guilty(this.kind, tick);
    const missed = tick.missed.length > 0 ? `; a deadline was missed by ${tick.missed.join(", ")}` : "";
    const longer = length(guilty) - this.ticks.median(this.kind, guilty);
    this.said.textContent = `${this.kind} ${tick.index} of ${this.all.length}: ${length(tick).toFixed(2)} ms${missed}. ` +
      `Guilty: ${guilty.name}, ${longer.toFixed(2)} ms longer than its median.`;
    this.drawRows(guilty);
    table(this.parts, ["part", "ms", "median, ms", "longer by, ms"], tick.parts.map((part) => this.partRow(part, guilty)));
  }

  private partRow(part: Part, guilty: Part): (string | HTMLElement)[] {
    const median = this.ticks.median(this.kind, part);
    const name = document.createElement("span");
    [name.textContent, name.className] = part === guilty ? [`${part.name} (guilty)`, "error"] : [part.name, ""];
    return [name, length(part).toFixed(3), median.toFixed(3), (length(part) - median).toFixed(3)];
  }

  private drawRows(guilty: Part): void {
    const { tick, ticks, rows } = this;
    const margin = Math.max(around * length(tick), 0.01);
    const [from, to] = [tick.from - margin, tick.to + margin];
    rows.replaceChildren();
    this.drawScale(from, to);
    ticks.trace.threads.forEach(({ name }, thread) => {
      const spans = ticks.within(thread, from, to);
      if (spans.length === 0) return;
      const row = element("div", rows, "", "row");
      element("span", row, name);
      const track = element("div", row, "", "flame");
      track.style.height = `${row_height * (1 + Math.max(...spans.map(({ depth }) => depth))) + 1}px`;
      const place = (bar: HTMLElement, part: { from: number; to: number }, depth: number) => {
        const [left, right] = [part.from, part.to].map((t) => (100 * (Math.min(Math.max(t, from), to) - from)) / (to - from));
        bar.style.left = `${left}%`;
        bar.style.width = `${right! - left!}%`;
        bar.style.top = `${row_height * depth + 1}px`;
        return right! - left!;
      };
      for (const part of tick.parts.filter((p) => !p.span && p.thread === thread))
        this.label(element("i", track, "", part === guilty ? "wait guilty" : "wait"), part.name, part, place);
      for (const span of spans) this.label(element("i", track, "", this.classOf(span, guilty)), span.what, span, place, span.depth);
    });
  }

  private label(
    bar: HTMLElement, name: string, at: { from: number; to: number },
    place: (bar: HTMLElement, at: { from: number; to: number }, depth: number) => number, depth = 0,
  ): void {
    if (place(bar, at, depth) >= named_from) bar.textContent = name;
    bar.title = `${name}: ${length(at).toFixed(3)} ms`;
  }

  // Those of the tick, its guilty one, and what else the threads did meanwhile.
  private classOf(span: Span, guilty: Part): string {
    if (span === guilty.span) return "guilty";
    return this.tick.parts.some((part) => part.span?.outermost === span.outermost) ? "own" : "";
  }

  private drawScale(from: number, to: number): void {
    const row = element("div", this.rows, "", "row");
    element("span", row, "ms");
    const scale = element("div", row, "", "flame");
    const step = roundStep((60 * (to - from)) / Math.max(scale.clientWidth, 1)); // 60 px a mark
    for (let t = 0; this.tick.from + t <= to; t += step) {
      const mark = element("b", scale, `${Number(t.toPrecision(6))}`);
      mark.style.left = `${(100 * (this.tick.from + t - from)) / (to - from)}%`;
    }
  }
}
