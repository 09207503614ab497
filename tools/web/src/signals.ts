// Every number of the messages of the last ten minutes, by its channel and field.

export const kept = 600; // s of data

export interface Signal {
  seconds: number[]; // since the first message
  values: number[];
}

const longest_list = 9; // of numbers; a longer one is no set of signals
const most_named = 32;
const left_out = new Set(["header", "utime", "track_from_u", "track_from_v", "track_u", "track_v", "point_x", "point_y", "point_z"]);

function timeOf(message: Record<string, unknown>): number | null {
  const header = message["header"] as { stamp_ns?: number } | undefined;
  if (typeof header?.stamp_ns === "number") return header.stamp_ns * 1e-9;
  const utime = message["utime"];
  return typeof utime === "number" ? utime * 1e-6 : null;
}

export class Signals {
  // By "CHANNEL/field", "CHANNEL/field.2" of a list, "CHANNEL/field.name.other" of a list of things that have names.
  readonly all = new Map<string, Signal>();
  now = 0; // s since the first message
  private first: number | null = null;

  // `message` is what a channel's message is as JSON.
  take(channel: string, message: unknown): void {
    if (typeof message !== "object" || message === null || Array.isArray(message)) return;
    const fields = message as Record<string, unknown>;
    const time = timeOf(fields);
    if (time !== null) {
      this.first ??= time;
      const at = time - this.first;
      // A replay was sought in or begun anew: what was is another drive.
      if (at < this.now - 5) {
        this.all.clear();
        this.first = time;
        this.now = 0;
      } else {
        this.now = Math.max(this.now, at);
      }
    }
    const at = time === null ? this.now : time - this.first!;
    for (const [name, value] of Object.entries(fields)) if (!left_out.has(name)) this.add(`${channel}/${name}`, value, at);
  }

  private add(name: string, value: unknown, at: number): void {
    if (typeof value === "number" || typeof value === "boolean") this.put(name, Number(value), at);
    else if (Array.isArray(value)) this.addList(name, value, at);
    else if (typeof value === "object" && value !== null)
      for (const [key, inner] of Object.entries(value)) this.add(`${name}.${key}`, inner, at);
  }

  private addList(name: string, list: unknown[], at: number): void {
    list.slice(0, most_named).forEach((item, i) => {
      if (typeof item === "number") {
        if (list.length <= longest_list) this.put(`${name}.${i}`, item, at);
      } else if (Array.isArray(item)) {
        if (typeof item[i] === "number") this.put(`${name}.${i}.${i}`, item[i] as number, at); // the diagonal of a matrix
      } else if (typeof item === "object" && item !== null) {
        const { name: own, ...rest } = item as Record<string, unknown>;
        if (typeof own === "string") this.add(`${name}.${own}`, rest, at);
      }
    });
  }

  private put(name: string, value: number, at: number): void {
    let signal = this.all.get(name);
    if (!signal) this.all.set(name, (signal = { seconds: [], values: [] }));
    const { seconds, values } = signal;
    if (seconds.length > 0 && at <= seconds[seconds.length - 1]!) return;
    seconds.push(at);
    values.push(value);
    if (seconds[0]! < this.now - kept - 30) {
      const old = seconds.findIndex((s) => s >= this.now - kept);
      seconds.splice(0, old);
      values.splice(0, old);
    }
  }
}
