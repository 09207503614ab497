// Controls of a replay; hidden as long as nobody plays one.
import { button, element } from "./dom";
import { command, type Player, type Run } from "./live";

export class PlayerBar {
  private state: Player | undefined;
  private run = ""; // the id of the one that is controlled
  private readonly play: HTMLButtonElement;
  private readonly slider: HTMLInputElement;
  private readonly clock: HTMLElement;
  private readonly speed: HTMLSelectElement;
  private readonly said: HTMLElement;
  private dragging = false;

  constructor(private readonly bar: HTMLElement) {
    bar.hidden = true;
    this.play = button(bar, "Pause", "Pause, or go on (space bar)", () => this.toggle());
    button(bar, "Step", "To the next image (.)", () => this.send("step-image"));
    this.slider = element("input", bar) as HTMLInputElement;
    this.slider.type = "range";
    this.slider.step = "0.1";
    this.slider.min = "0";
    this.slider.title = this.slider.ariaLabel = "Seek";
    this.slider.addEventListener("input", () => (this.dragging = true));
    this.slider.addEventListener("change", () => {
      this.dragging = false;
      this.send("seek", Number(this.slider.value));
    });
    this.clock = element("span", bar, "", "clock");
    this.speed = element("select", bar) as HTMLSelectElement;
    this.speed.title = this.speed.ariaLabel = "Times real time";
    for (const times of [0.1, 0.25, 0.5, 1, 2, 4]) {
      const option = element("option", this.speed, `${times}×`) as HTMLOptionElement;
      option.value = `${times}`;
    }
    this.speed.addEventListener("change", () => this.send("speed", Number(this.speed.value)));
    button(bar, "Next miss", "Play to the next missed deadline (n)", () => this.send("next-miss"));
    this.said = element("span", bar, "", "error");
    document.addEventListener("keydown", (e) => this.pressed(e));
  }

  show(run: Run | undefined): void {
    this.run = run?.id ?? "";
    this.bar.hidden = !run?.player;
    if (run?.player) this.showState(run.player);
  }

  private showState(state: Player): void {
    this.state = state;
    const length = (state.last_ns - state.first_ns) * 1e-9;
    const at = (state.position_ns - state.first_ns) * 1e-9;
    this.slider.max = length.toFixed(1);
    if (!this.dragging) this.slider.value = `${at}`;
    this.clock.textContent = `${at.toFixed(1)} of ${length.toFixed(1)} s${state.seeking ? ", seeking" : ""}`;
    this.play.textContent = state.paused ? "Play" : "Pause";
    this.speed.value = `${state.speed}`;
    this.said.textContent = state.refused;
  }

  private toggle(): void {
    this.send(this.state?.paused ? "resume" : "pause");
  }

  private send(kind: string, value = 0): void {
    command(this.run, kind, value).then(
      () => (this.said.textContent = ""),
      (e: unknown) => (this.said.textContent = e instanceof Error ? e.message : String(e)),
    );
  }

  private pressed(e: KeyboardEvent): void {
    if (this.bar.hidden || e.target instanceof HTMLSelectElement) return;
    if (e.key === " ") this.toggle();
    else if (e.key === ".") this.send("step-image");
    else if (e.key === "n") this.send("next-miss");
    else return;
    e.preventDefault();
  }
}
