// Which of the runs on the bus the page shows: the one that its address names (?run=ID), else the first there is.
import { element } from "./dom";
import type { Run } from "./live";

export class RunChoice {
  shown: Run | undefined; // the last that is known of it
  readonly pinned = new URLSearchParams(location.search).get("run");
  isMissing = false; // the bus has not the one that the address names

  private readonly label: HTMLElement;
  private readonly select: HTMLSelectElement;

  // `show` is called with the run that is to be shown.
  constructor(parent: HTMLElement, private readonly show: (run: string) => void) {
    this.label = element("label", parent, "Run ", "run");
    this.label.hidden = true;
    this.select = element("select", this.label) as HTMLSelectElement;
    this.select.setAttribute("aria-label", "Run");
    this.select.addEventListener("change", () => {
      location.href = `?${new URLSearchParams({ run: this.select.value })}${location.hash}`;
    });
  }

  // A run stays for as long as the dashboard knows it, also after its end. A page that followed it begins anew with the next.
  take(runs: Run[]): void {
    const wanted = this.pinned ?? this.shown?.id;
    const next = runs.find((r) => r.id === wanted) ?? (this.pinned ? undefined : (runs.find((r) => !r.ended) ?? runs[0]));
    if (this.shown && next && this.shown.id !== next.id) location.reload();
    this.isMissing = this.pinned !== null && !next;
    this.offer(runs);
    if (!next) return;
    this.shown = next;
    this.select.value = next.id;
    this.show(next.id);
  }

  private offer(runs: Run[]): void {
    this.label.hidden = runs.length < 2 && !(this.isMissing && runs.length > 0);
    const options = runs.map(({ id, what, ended }) => new Option(`${what} (${id})${ended ? ", ended" : ""}`, id));
    if (this.isMissing) options.unshift(new Option(`${this.pinned} is not there`, this.pinned!));
    if ([...this.select.options].map((o) => o.text).join() !== options.map((o) => o.text).join()) this.select.replaceChildren(...options);
  }
}
