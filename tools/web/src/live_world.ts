// What the dashboard knows of the place: where the vehicle has been and is, its road, and what it has scanned.
import { enu, type Geodetic } from "./geodesy";
import { roads, type Fix, type MapMatch, type NavState, type Pose, type Preview, type Trail } from "./live";
import type { Line } from "./plot";

const most = 20000; // points of a line
const most_scanned = 100_000; // points of all scans
const remembered = 50; // states, by which scans find their place

export type Place = [east: number, north: number, up: number]; // m

export class Way {
  readonly line: Line;
  readonly up: number[] = [];
  private readonly seconds: number[] = [];

  constructor(name: string) {
    this.line = { name, x: [], y: [] };
  }

  clear(): void {
    this.seconds.length = this.up.length = this.line.x.length = this.line.y.length = 0;
  }

  // What lies after it is forgotten: a replay may go back.
  add(second: number, [east, north, up]: Place): void {
    while (this.seconds.length > 0 && this.seconds[this.seconds.length - 1]! >= second) this.drop("pop");
    this.seconds.push(second);
    this.line.x.push(east);
    this.line.y.push(north);
    this.up.push(up);
    if (this.seconds.length > most) this.drop("shift");
  }

  private drop(end: "pop" | "shift"): void {
    this.seconds[end]();
    this.line.x[end]();
    this.line.y[end]();
    this.up[end]();
  }
}

// The axes of the vehicle's frame, forward, left and up, in east, north and up.
export function axesOf({ azimuth, pitch, roll }: NavState): [Place, Place, Place] {
  const [sa, ca, sp, cp] = [Math.sin(azimuth), Math.cos(azimuth), Math.sin(pitch), Math.cos(pitch)];
  const [sr, cr] = [Math.sin(roll), Math.cos(roll)];
  const left: Place = [-ca, sa, 0];
  const up: Place = [-sp * sa, -sp * ca, cp];
  const turned = (a: Place, x: number, b: Place, y: number) => a.map((v, i) => x * v + y * b[i]!) as Place;
  return [[cp * sa, cp * ca, sp], turned(left, cr, up, sr), turned(up, cr, left, -sr)];
}

export class LiveWorld {
  readonly truth = new Way("truth");
  readonly fused = new Way("fused");
  readonly fixes = new Way("fixes");
  readonly scans: Float32Array[] = []; // the newest last; east, north and up of each point
  roads: Line[] = [];
  origin: Geodetic | undefined;
  state: NavState | undefined;
  match: MapMatch | undefined;

  private states: NavState[] = [];
  private readonly drawn: (() => void)[] = [];

  // Calls after each change.
  onChange(draw: () => void): void {
    this.drawn.push(draw);
  }

  load(trail: Trail): void {
    const [latitude, longitude, height] = trail.origin;
    this.begin({ latitude, longitude, height });
    for (const [s, ...place] of trail.fused) this.fused.add(s, place);
    for (const [s, ...place] of trail.truth) this.truth.add(s, place);
    this.changed();
  }

  addState(state: NavState): void {
    this.state = state.status === 0 ? undefined : state;
    if (!this.state) return;
    const origin = {
      latitude: state.origin_latitude,
      longitude: state.origin_longitude,
      height: state.origin_height,
    };
    if (this.origin?.latitude !== origin.latitude || this.origin.longitude !== origin.longitude) this.begin(origin);
    this.fused.add(state.header.stamp_ns * 1e-9, state.position_enu as Place);
    if (state.header.stamp_ns < (this.states[this.states.length - 1]?.header.stamp_ns ?? 0)) this.states = [];
    this.states = [...this.states.slice(1 - remembered), state];
    this.changed();
  }

  addTruth(pose: Pose): void {
    this.addTo(this.truth, pose);
  }

  addFix(fix: Fix): void {
    this.addTo(this.fixes, fix);
  }

  addMatch(match: MapMatch): void {
    const here = match.origin_latitude === this.origin?.latitude && match.origin_longitude === this.origin?.longitude;
    this.match = match.on_road && here ? match : undefined;
    this.changed();
  }

  // Puts the scan where the vehicle was, by the nearest state and its velocity.
  addScan({ scan_stamp_ns, point_count, point_x, point_y, point_z }: Preview): void {
    const since = (s: NavState) => (scan_stamp_ns - s.header.stamp_ns) * 1e-9;
    const near = [...this.states].sort((a, b) => Math.abs(since(a)) - Math.abs(since(b)))[0];
    if (point_count === 0 || !near || Math.abs(since(near)) > 1) return;
    const at = near.position_enu.map((p, i) => p + near.velocity_enu[i]! * since(near));
    const [forward, left, up] = axesOf(near);
    const points = new Float32Array(3 * point_count);
    for (let i = 0; i < point_count; ++i) {
      const [x, y, z] = [0.01 * point_x[i]!, 0.01 * point_y[i]!, 0.01 * point_z[i]!];
      for (let k = 0; k < 3; ++k) points[3 * i + k] = at[k]! + x * forward[k]! + y * left[k]! + z * up[k]!;
    }
    this.scans.push(points);
    while (this.scans.reduce((sum, scan) => sum + scan.length / 3, 0) > most_scanned) this.scans.shift();
    this.changed();
  }

  private changed(): void {
    for (const draw of this.drawn) draw();
  }

  private begin(origin: Geodetic): void {
    this.origin = origin;
    for (const way of [this.truth, this.fused, this.fixes]) way.clear();
    this.scans.length = 0;
    this.states = [];
    this.roads = [];
    roads(origin).then(
      (lines) => {
        if (this.origin !== origin) return; // there is a later one
        this.roads = lines;
        this.changed();
      },
      () => undefined, // the next origin asks again
    );
  }

  private addTo(way: Way, pose: Pose): void {
    if (!this.origin) return;
    way.add(pose.header.stamp_ns * 1e-9, enu(pose, this.origin));
    this.changed();
  }
}
