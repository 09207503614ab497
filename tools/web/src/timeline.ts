// One cursor and one stretch of time for all pictures of a page, moved by a slider, by keys, and from the pictures.
import { button, element } from "./dom";

export interface View {
  at: number; // time of the cursor
  from: number; // stretch that is shown
  to: number;
}

// An event is at a time, or lasts for a while (tools/web/plot.h).
export interface TimelineEvent {
  from: number;
  to: number;
  level: "note" | "warning" | "error";
  text: string;
  section: string; // id of the heading where there is more; may be empty
}

export const levelTokens = { note: "soft", warning: "warning", error: "error" } as const;

export class Timeline {
  readonly view: View;
  private readonly followers: ((view: View) => void)[] = [];

  constructor(
    readonly whole: [number, number],
    readonly text: (time: number) => string,
    readonly events: TimelineEvent[] = [],
    readonly clock?: (time: number) => string, // of the axes of charts, where times are of the day
  ) {
    this.view = { at: whole[0], from: whole[0], to: whole[1] };
  }

  // Calls now, and whenever the view has changed.
  follow(show: (view: View) => void): void {
    this.followers.push(show);
    show(this.view);
  }

  change(change: Partial<View>): void {
    const { view, whole } = this;
    Object.assign(view, change);
    const least = (whole[1] - whole[0]) / 1000;
    view.from = Math.min(Math.max(view.from, whole[0]), whole[1] - least);
    view.to = Math.max(Math.min(view.to, whole[1]), view.from + least);
    view.at = Math.min(Math.max(view.at, view.from), view.to);
    for (const show of this.followers) show(view);
  }

  all(): void {
    this.change({ from: -Infinity, to: Infinity });
  }

  addControls(parent: HTMLElement, name: string): void {
    const row = element("div", parent, "", "time");
    const label = element("label", row, name);
    const slider = element("input", label) as HTMLInputElement;
    slider.type = "range";
    slider.addEventListener("input", () => this.change({ at: Number(slider.value) }));
    const now = element("output", row);
    button(row, "+", "Shorter part of the time", () => this.zoom(0.5));
    button(row, "−", "Longer part of the time", () => this.zoom(2));
    button(row, "All", "Show all of the time", () => this.all());
    if (this.events.length > 0) this.addStrip(element("div", parent, "", "strip-of-events"));
    this.follow((view) => {
      slider.min = `${view.from}`;
      slider.max = `${view.to}`;
      slider.step = `${(view.to - view.from) / 1000}`;
      slider.value = `${view.at}`;
      now.textContent = this.text(view.at);
      slider.setAttribute("aria-valuetext", this.text(view.at));
    });
  }

  // The events as a list, each of which leads to its time; a heading that tells more is linked.
  addEvents(parent: HTMLElement): void {
    if (this.events.length === 0) return void element("p", parent, "Nothing was out of the ordinary.", "empty");
    const list = element("ul", parent, "", "events");
    for (const event of this.events) {
      const item = element("li", list);
      const lasts = event.to > event.from ? `, ${Number((event.to - event.from).toPrecision(3))} s` : "";
      const go = button(item, `${this.text(event.from)}${lasts}`, "Move the cursor there", () => this.goTo(event));
      go.classList.add("key");
      go.style.setProperty("--key", `var(--${levelTokens[event.level]})`);
      element("span", item, ` ${event.text} `);
      if (event.section) (element("a", item, "more") as HTMLAnchorElement).href = `#${event.section}`;
    }
  }

  private zoom(factor: number): void {
    const half = (factor * (this.view.to - this.view.from)) / 2;
    this.change({ from: this.view.at - half, to: this.view.at + half });
  }

  // Moves the cursor to the beginning of a stretch, and shows the whole of it.
  goTo({ from, to }: { from: number; to: number }): void {
    const half = Math.max((this.view.to - this.view.from) / 2, to - from);
    const isSeen = from >= this.view.from && to <= this.view.to;
    this.change(isSeen ? { at: from } : { at: from, from: from - half, to: to + half });
  }

  // For the mouse; for keys and reading aloud there is the list.
  private addStrip(strip: HTMLElement): void {
    strip.ariaHidden = "true";
    const parts = this.events.map((event) => {
      const part = element("i", strip);
      part.title = `${this.text(event.from)}: ${event.text}`;
      part.style.background = `var(--${levelTokens[event.level]})`;
      part.addEventListener("click", () => this.goTo(event));
      return part;
    });
    this.follow(({ from, to }) => {
      const place = (time: number) => (100 * (Math.min(Math.max(time, from), to) - from)) / (to - from);
      this.events.forEach((event, i) => {
        parts[i]!.hidden = event.to < from || event.from > to;
        parts[i]!.style.left = `${place(event.from)}%`;
        parts[i]!.style.width = `${place(event.to) - place(event.from)}%`;
      });
    });
  }
}

export function seconds(time: number): string {
  return `${Number(time.toFixed(2))} s`;
}

// The time of the day from that of the first second.
export function clockFrom(start: number): (time: number) => string {
  return (time) => {
    const tenths = Math.round(10 * (start + time));
    const whole = Math.floor(tenths / 10) % 86400;
    const two = (v: number) => `${Math.floor(v)}`.padStart(2, "0");
    const clock = `${two(whole / 3600)}:${two((whole / 60) % 60)}:${two(whole % 60)}`;
    return tenths % 10 === 0 ? clock : `${clock}.${tenths % 10}`;
  };
}
