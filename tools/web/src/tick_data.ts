// The ticks of a traced run: which spans of which threads made each, how long its parts took, and which was guilty.

// As tools/profile/trace_ticks.h writes it; times are in units of 100 ns.
export interface Trace {
  names: string[];
  threads: { name: string; start: number[]; lasted: number[]; what: number[]; missed: number[] }[];
  flows: { source: string; sequence: number; spans: [thread: number, span: number][] }[];
  until: number | null;
}

// Times are in ms since the start of the trace.
export interface Span {
  thread: number;
  what: string;
  from: number;
  to: number;
  depth: number; // how many spans are around it
  outermost: Span; // of these, or itself
}

export interface Part {
  name: string; // what ran, or what was waited for
  from: number;
  to: number;
  thread: number;
  span?: Span; // that ran; a wait has none
}

export interface Tick {
  index: number; // among its kind
  sequence: number;
  from: number;
  to: number;
  parts: Part[];
  missed: string[]; // threads that missed their deadline in it
}

export const length = ({ from, to }: { from: number; to: number }) => to - from;

// The one that is at a share of all; there is at least one.
function percentile<Value>(sorted: Value[], share: number): Value {
  return sorted[Math.min(sorted.length - 1, Math.floor(share * sorted.length))]!;
}

export class Ticks {
  readonly spans: Span[][]; // of each thread, in the order of time
  readonly kinds = new Map<string, Tick[]>(); // by source
  private readonly late: Set<Span>;
  private readonly medians = new Map<string, number>(); // of parts, by kind and name

  constructor(readonly trace: Trace) {
    this.spans = trace.threads.map(({ start, lasted, what }, thread) => {
      let at = 0;
      const open: Span[] = [];
      return start.map((step, i) => {
        at += step;
        const span = { thread, what: trace.names[what[i]!]!, from: at * 1e-4, to: (at + lasted[i]!) * 1e-4 } as Span;
        while (open.length > 0 && open[open.length - 1]!.to <= span.from) open.pop();
        span.depth = open.length;
        span.outermost = open[0] ?? span;
        open.push(span);
        return span;
      });
    });
    this.late = new Set(trace.threads.flatMap(({ missed }, thread) => missed.map((i) => this.spans[thread]![i]!)));
    for (const { source, sequence, spans } of trace.flows) {
      const parts = this.way(spans.map(([thread, i]) => this.spans[thread]![i]!));
      this.add(source, sequence, parts);
    }
    this.addFusion();
    for (const [kind, ticks] of this.kinds) this.measure(kind, ticks);
  }

  // The one that is longer than a share of all.
  atPercentile(kind: string, share: number): Tick {
    return percentile([...this.kinds.get(kind)!].sort((a, b) => length(a) - length(b)), share);
  }

  median(kind: string, part: Part): number {
    return this.medians.get(`${kind}/${part.name}`)!;
  }

  // The part that took longest beyond its median.
  guilty(kind: string, { parts }: Tick): Part {
    const beyond = (part: Part) => length(part) - this.median(kind, part);
    return parts.reduce((worst, part) => (beyond(part) > beyond(worst) ? part : worst));
  }

  // Spans that were there from one time to another.
  within(thread: number, from: number, to: number): Span[] {
    return this.spans[thread]!.filter((span) => span.to >= from && span.from <= to);
  }

  // What ran, with the waits in between.
  private way(steps: Span[]): Part[] {
    const parts: Part[] = [];
    let before: Span | undefined;
    for (const step of steps) {
      const name = this.trace.threads[step.thread]!.name;
      if (before && step.from > before.to)
        parts.push({ name: `waiting for ${name}`, from: before.to, to: step.from, thread: step.thread });
      parts.push({ name: `${name}: ${step.what}`, from: step.from, to: step.to, thread: step.thread, span: step });
      before = step;
    }
    return parts;
  }

  // A tick of the fusion has what is inside its span, and the rest of it.
  private addFusion(): void {
    const thread = this.trace.threads.findIndex(({ name }) => name === "fusion");
    const all = this.spans[thread] ?? [];
    let number = 0;
    all.forEach((tick, i) => {
      if (tick.what !== "tick" || tick.depth > 0) return;
      const parts: Part[] = [];
      let at = tick.from;
      const add = (name: string, from: number, to: number, span?: Span) => {
        if (to > from) parts.push({ name, from, to, thread, ...(span && { span }) });
      };
      for (let k = i + 1; k < all.length && all[k]!.depth > 0; ++k) {
        const inner = all[k]!;
        if (inner.depth !== 1) continue;
        add("fusion: tick", at, inner.from, tick);
        if (inner.what.startsWith("waiting")) add(inner.what, inner.from, inner.to);
        else add(`fusion: ${inner.what}`, inner.from, inner.to, inner);
        at = inner.to;
      }
      add("fusion: tick", at, tick.to, tick);
      if (parts.length > 0) this.add("fusion tick", number++, parts);
    });
  }

  private add(kind: string, sequence: number, parts: Part[]): void {
    let ticks = this.kinds.get(kind);
    if (!ticks) this.kinds.set(kind, (ticks = []));
    const [from, to] = [parts[0]!.from, parts[parts.length - 1]!.to];
    ticks.push({ index: ticks.length, sequence, from, to, parts, missed: [] });
  }

  private measure(kind: string, ticks: Tick[]): void {
    const lengths = new Map<string, number[]>();
    for (const { parts } of ticks)
      for (const part of parts) {
        const list = lengths.get(part.name);
        if (list) list.push(length(part));
        else lengths.set(part.name, [length(part)]);
      }
    for (const [name, list] of lengths) this.medians.set(`${kind}/${name}`, percentile(list.sort((a, b) => a - b), 0.5));
    // The threads that a tick passes say themselves which of their spans were late.
    for (const tick of ticks) {
      const late = tick.parts.filter(({ span }) => span && this.late.has(span.outermost));
      tick.missed = [...new Set(late.map(({ thread }) => this.trace.threads[thread]!.name))];
    }
  }
}
