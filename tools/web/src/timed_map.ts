// A map of tracks with where they are at the cursor of a timeline; moving over a track moves the cursor.
import { between, nearest } from "./series";
import { button, element } from "./dom";
import { MapView } from "./map";
import { ink, tokensOf } from "./palette";
import type { Line } from "./plot";
import type { Timeline } from "./timeline";

export class TimedMap {
  readonly view: MapView;
  private tracks: (Line & { token: string })[] = [];
  private shown: [number, number] = [NaN, NaN];

  // The figure must be on the page. Without a timeline nothing moves.
  constructor(
    figure: HTMLElement,
    title: string,
    private readonly timeline?: Timeline,
  ) {
    const frame = element("div", figure, "", "frame");
    const canvas = element("canvas", frame, "", "map") as HTMLCanvasElement;
    canvas.setAttribute("role", "img");
    canvas.setAttribute("aria-label", title);
    this.view = new MapView(canvas, false);
    this.view.extra = (_, context) => this.drawMarkers(context);
    const buttons = element("div", frame, "", "buttons");
    button(buttons, "+", "Nearer", () => this.view.zoom(1.5));
    button(buttons, "−", "Farther", () => this.view.zoom(1 / 1.5));
    button(buttons, "⤢", "Show the whole way", () => this.view.fit());
    const moveTo = (e: MouseEvent) => {
      const time = this.timeAt(e.offsetX, e.offsetY);
      if (time !== undefined) timeline!.change({ at: time });
    };
    canvas.addEventListener("pointermove", (e) => {
      if (e.buttons !== 0) return;
      moveTo(e);
      canvas.title = this.view.roadAt(e.offsetX, e.offsetY);
    });
    canvas.addEventListener("click", moveTo); // of a finger
  }

  // The tracks are seen in the stretch of time that is shown.
  setTracks(tracks: Line[]): void {
    const tokens = tokensOf(tracks.map((track) => track.name));
    const isFirst = this.tracks.length === 0;
    this.tracks = tracks.map((track, i) => ({ ...track, token: track.token ?? tokens[i]! }));
    if (isFirst && this.timeline) this.timeline.follow(() => this.follow());
    else this.refresh(isFirst);
  }

  refresh(fit = false): void {
    this.view.lines = this.tracks.map((track) => {
      const [from, to] = this.part(track);
      return { ...track, x: track.x.slice(from, to), y: track.y.slice(from, to) };
    });
    if (fit) this.view.fit();
    this.view.redraw();
  }

  // The indices of what is shown of a track.
  part(track: Line): [number, number] {
    if (!this.timeline || !track.time?.length) return [0, track.x.length];
    const { from, to } = this.timeline.view;
    return [nearest(track.time, from), nearest(track.time, to) + 1];
  }

  private follow(): void {
    const { from, to } = this.timeline!.view;
    if (from === this.shown[0] && to === this.shown[1]) return this.keepInSight();
    this.shown = [from, to];
    this.refresh(true);
  }

  // Where the map was moved or zoomed, it goes with the cursor.
  private keepInSight(): void {
    const place = this.placesAtCursor()[0];
    if (place && !this.view.shows(place.east, place.north)) this.view.centre(place.east, place.north);
    this.view.redraw();
  }

  private placesAtCursor(): { east: number; north: number; token: string }[] {
    return this.tracks.flatMap(({ time, x, y, token }) => {
      if (!this.timeline || !time?.length) return [];
      const [east, north] = [between(time, x, this.timeline.view.at), between(time, y, this.timeline.view.at)];
      return east === null || north === null ? [] : [{ east, north, token }];
    });
  }

  drawMarkers(context: CanvasRenderingContext2D): void {
    for (const { east, north, token } of this.placesAtCursor()) {
      context.beginPath();
      context.arc(this.view.x(east), this.view.y(north), 6, 0, 2 * Math.PI);
      context.fillStyle = ink(token);
      context.strokeStyle = ink("surface");
      context.lineWidth = 2;
      context.fill();
      context.stroke();
    }
  }

  // Of the place under the pointer, if there is one of a track near it.
  private timeAt(x: number, y: number): number | undefined {
    let [best, at] = [20, undefined as number | undefined]; // px
    for (const track of this.tracks) {
      if (!track.time?.length) continue;
      const [from, to] = this.part(track);
      for (let i = from; i < to; ++i) {
        const [east, north] = [track.x[i], track.y[i]];
        if (east == null || north == null) continue;
        const apart = Math.hypot(this.view.x(east) - x, this.view.y(north) - y);
        if (apart < best) [best, at] = [apart, track.time[i]!];
      }
    }
    return at;
  }
}
