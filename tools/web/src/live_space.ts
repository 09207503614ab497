// The place of the dashboard in 3-D: the vehicle with its axes, scans, the way, roads, and the road it is thought to be on.
import type { MapMatch, NavState } from "./live";
import { axesOf, type LiveWorld, type Place, type Way } from "./live_world";
import { Orbit } from "./orbit";
import { onColours } from "./palette";
import type { Line } from "./plot";
import { Space, type Lines } from "./space";

const above_ground = 0.9; // m, of the vehicle's origin
const box: [Place, Place] = [[-2.2, -0.9, -0.7], [2.2, 0.9, 0.8]]; // m, of the vehicle
const roads_within = 500; // m
const moves_within = 40; // ms from picture to picture, else clouds are thinned ...
const rests_after = 1000; // ms ... until nothing has moved for this long
const most_thinned = 32;

// All points of a line at a height.
function flat({ x, y }: Line, up: number): Float32Array {
  return Float32Array.from(x.flatMap((east, i) => [east!, y[i]!, up]));
}

function pairs(lines: Line[], up: number): Float32Array {
  return Float32Array.from(
    lines.flatMap(({ x, y }) => x.slice(1).flatMap((east, i) => [x[i]!, y[i]!, up, east!, y[i + 1]!, up])),
  );
}

function wayPoints({ line: { x, y }, up }: Way): Float32Array {
  return Float32Array.from(up.flatMap((u, i) => [x[i]!, y[i]!, u - above_ground]));
}

// A post of a metre at each place.
function posts({ line: { x, y } }: Way, ground: number): Float32Array {
  return Float32Array.from(x.flatMap((east, i) => [east!, y[i]!, ground, east!, y[i]!, ground + 1]));
}

function distance({ x, y }: Line, [east, north]: number[]): number {
  let least = Infinity;
  for (let i = 1; i < x.length; ++i) {
    const [ax, ay, dx, dy] = [x[i - 1]! - east!, y[i - 1]! - north!, x[i]! - x[i - 1]!, y[i]! - y[i - 1]!];
    const share = Math.min(Math.max(-(ax * dx + ay * dy) / (dx * dx + dy * dy || 1), 0), 1);
    least = Math.min(least, Math.hypot(ax + share * dx, ay + share * dy));
  }
  return least;
}

export class LiveSpace {
  follow = true;
  scans = 1; // the newest ones that are shown

  private readonly space: Space | undefined;
  private readonly orbit: Orbit;
  private waiting = false;
  private nth = 1; // point of clouds that is drawn
  private drawnAt = 0; // ms
  private rest = 0; // a timer
  private near: { roads: Line[]; about: number[]; lines: Line[] } = { roads: [], about: [], lines: [] };

  constructor(
    private readonly canvas: HTMLCanvasElement,
    private readonly world: LiveWorld,
    moved: () => void,
  ) {
    this.space = Space.on(canvas, () => this.redraw());
    this.orbit = new Orbit(canvas, () => this.redraw(), moved);
    world.onChange(() => this.refresh());
    new ResizeObserver(() => this.redraw()).observe(canvas);
    onColours(() => this.redraw());
  }

  get isPossible(): boolean {
    return this.space !== undefined;
  }

  zoom(factor: number): void {
    this.orbit.zoom(factor);
  }

  // Shows all of the way.
  fit(): void {
    const { line, up } = this.world.fused;
    const middle = (list: number[]) => (Math.min(...list) + Math.max(...list)) / 2;
    if (up.length === 0) return;
    const place = [line.x as number[], line.y as number[], up].map(middle);
    this.orbit.fit(place, Math.max(20, ...line.x.map((east, i) => Math.hypot(east! - place[0]!, line.y[i]! - place[1]!))));
  }

  refresh(): void {
    const { state } = this.world;
    if (state && this.follow) this.orbit.target = state.position_enu;
    this.redraw();
  }

  private redraw(): void {
    if (this.waiting || this.canvas.hidden) return;
    this.waiting = true;
    requestAnimationFrame((now) => {
      this.waiting = false;
      this.pace(now);
      this.draw();
    });
  }

  // A computer that is too slow for all points draws fewer of them while the eye moves.
  private pace(now: number): void {
    const took = now - this.drawnAt;
    this.drawnAt = now;
    clearTimeout(this.rest);
    if (!this.orbit.isHeld) return void (this.nth = 1);
    if (took > moves_within && took < rests_after) this.nth = Math.min(2 * this.nth, most_thinned);
    this.rest = setTimeout(() => {
      this.nth = 1;
      this.draw();
    }, rests_after);
  }

  private draw(): void {
    const { canvas, world } = this;
    const [width, height] = [canvas.clientWidth, canvas.clientHeight].map((v) => Math.max(1, Math.round(v * devicePixelRatio)));
    if (canvas.width !== width || canvas.height !== height) [canvas.width, canvas.height] = [width!, height!];
    const ground = (world.state?.position_enu[2] ?? 0) - above_ground;
    const lines: Lines[] = [
      ...this.roads(ground),
      { points: wayPoints(world.truth), look: "chain", token: "truth", metres: 0.5, px: 1, opacity: 0.5 },
      { points: wayPoints(world.fused), look: "chain", token: "fused", px: 3 },
      { points: posts(world.fixes, ground), look: "pairs", token: "gnss", px: 4 },
      ...(world.match ? this.matched(world.match, ground) : []),
      ...(world.state ? this.vehicle(world.state) : []),
    ];
    const clouds = world.scans.slice(-this.scans).map((points) => ({ points, heights: [ground - 0.5, 5] as [number, number] }));
    this.space?.draw(this.orbit.eye(width!, height!), lines, clouds, this.nth);
  }

  // Roads within reach: far ones are sought again when the vehicle has moved.
  private roads(ground: number): Lines[] {
    const { roads, state } = this.world;
    const at = state?.position_enu ?? [0, 0];
    const isOld = this.near.roads !== roads || !(Math.hypot(at[0]! - this.near.about[0]!, at[1]! - this.near.about[1]!) < 100);
    if (isOld) this.near = { roads, about: at, lines: roads.filter((road) => distance(road, at) < roads_within) };
    const points = pairs(this.near.lines, ground);
    return [
      { points, look: "pairs", token: "road-edge", metres: 7, px: 2, isBeneath: true },
      { points, look: "pairs", token: "road", metres: 6.4, isBeneath: true },
    ];
  }

  // The candidate links, the likelier the stronger, and the point on the road joined to where the vehicle was thought to be.
  // A candidate, "Street 7 (way 12)" or "way 12", is the road of its name at its distance.
  private matched({ candidates, vehicle_enu, matched_enu }: MapMatch, ground: number): Lines[] {
    const links = candidates.slice(0, 6).flatMap(({ road, distance: away, probability }): Lines[] => {
      const off = (line: Line) => Math.abs(distance(line, vehicle_enu) - (away ?? 0));
      const name = road.replace(/ ?\(?way \d+\)?$/, "");
      const [best] = this.near.lines.filter((line) => line.name === name).sort((a, b) => off(a) - off(b));
      const opacity = 0.15 + 0.6 * (probability || 0);
      return best ? [{ points: flat(best, ground), look: "chain", token: "matched", metres: 2.5, px: 1, opacity, isBeneath: true }] : [];
    });
    const [east, north] = matched_enu as [number, number];
    const place = Float32Array.of(vehicle_enu[0]!, vehicle_enu[1]!, ground, east, north, ground, east, north, ground, east, north, ground + 3);
    return [...links, { points: place, look: "pairs", token: "matched", px: 4 }];
  }

  private vehicle(state: NavState): Lines[] {
    const axes = axesOf(state);
    const at = (p: Place) => state.position_enu.map((v, k) => v + p.reduce((sum, d, i) => sum + d * axes[i]![k]!, 0));
    const corner = (i: number) => at([box[i & 1]![0], box[(i >> 1) & 1]![1], box[i >> 2]![2]]);
    const edges = [0, 1, 2, 3, 4, 5, 6, 7].flatMap((i) => [1, 2, 4].filter((bit) => !(i & bit)).flatMap((bit) => [...corner(i), ...corner(i | bit)]));
    const axis = (end: Place, token: string): Lines => ({ points: Float32Array.from([...at([0, 0, 0]), ...at(end)]), look: "pairs", token, px: 3 });
    return [
      { points: Float32Array.from(edges), look: "pairs", token: "fused", px: 2 },
      axis([3.5, 0, 0], "error"),
      axis([0, 2.5, 0], "good"),
      axis([0, 0, 2.5], "focus"),
    ];
  }
}
