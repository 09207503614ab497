// The place of the dashboard, as a map or in 3-D, with the buttons of both.
import { button, choice, element } from "./dom";
import { LiveMap } from "./live_map";
import { LiveSpace } from "./live_space";
import type { LiveWorld } from "./live_world";

export class LivePlace {
  private readonly map: LiveMap;
  private readonly space: LiveSpace;
  private readonly canvases: [map: HTMLCanvasElement, space: HTMLCanvasElement];
  private readonly refusal: HTMLElement; // where the browser cannot draw in 3-D
  private readonly bar: HTMLElement;
  private readonly followButton: HTMLButtonElement;
  private readonly spaceButton: HTMLButtonElement;
  private readonly scans: HTMLElement;

  constructor(place: HTMLElement, world: LiveWorld) {
    this.canvases = [element("canvas", place) as HTMLCanvasElement, element("canvas", place, "", "space") as HTMLCanvasElement];
    const canvas = this.canvases[1];
    canvas.tabIndex = 0;
    canvas.setAttribute("role", "img");
    canvas.ariaLabel = "The vehicle, its scans and its road in 3-D: arrows turn, with Shift they move, + and - zoom";
    this.refusal = element("p", place, "This browser has no WebGL 2, which draws in 3-D: the map has the same from above.", "empty");
    const legend = element("div", place, "", "legend");
    for (const [name, token] of [["truth", "truth"], ["fused", "fused"], ["fixes", "gnss"], ["matched", "matched"]] as const)
      element("span", legend, name).style.setProperty("--key", `var(--${token})`);
    const moved = () => this.setFollow(false);
    this.map = new LiveMap(this.canvases[0], world, moved);
    this.space = new LiveSpace(canvas, world, moved);
    this.bar = element("div", place, "", "buttons");
    this.scans = element("span", this.bar);
    const counts: [string, number][] = [["newest scan", 1], ["10 scans", 10], ["all scans", Infinity]];
    choice(this.scans, "show", counts, 1, (count) => {
      this.space.scans = count;
      this.space.refresh();
    });
    this.spaceButton = button(this.bar, "3-D", "The place in 3-D, or as a map", () => this.setSpace(canvas.hidden));
    this.followButton = button(this.bar, "◎", "Follow the vehicle", () => this.setFollow(true));
    button(this.bar, "+", "Nearer", () => this.shown.zoom(1.5));
    button(this.bar, "−", "Farther", () => this.shown.zoom(1 / 1.5));
    button(this.bar, "⤢", "Show all", () => {
      this.setFollow(false);
      this.shown.fit();
    });
    this.setFollow(true);
    this.setSpace(new URLSearchParams(location.hash.slice(1)).has("3d"));
  }

  private get shown(): LiveMap | LiveSpace {
    return this.canvases[1].hidden ? this.map : this.space;
  }

  private setFollow(yes: boolean): void {
    this.map.follow = this.space.follow = yes;
    this.followButton.setAttribute("aria-pressed", `${yes}`);
    this.space.refresh();
  }

  // Which one it is, is in the address.
  private setSpace(yes: boolean): void {
    const [map, space] = this.canvases;
    const isDrawn = yes && this.space.isPossible;
    [map.hidden, space.hidden, this.scans.hidden] = [yes, !yes, !isDrawn];
    this.refusal.hidden = !yes || isDrawn;
    this.spaceButton.setAttribute("aria-pressed", `${yes}`);
    const hash = new URLSearchParams(location.hash.slice(1));
    if (yes) hash.set("3d", "");
    else hash.delete("3d");
    if (yes !== new URLSearchParams(location.hash.slice(1)).has("3d")) history.replaceState(null, "", `#${hash}`);
    this.space.refresh();
  }
}
