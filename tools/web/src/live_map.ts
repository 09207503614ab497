// The map of the dashboard: where the vehicle has been and is, and how sure of it it is.
import { eastNorth, type Geodetic } from "./geodesy";
import { roads, type Fix, type MapMatch, type NavState, type Pose, type Trail } from "./live";
import { MapView } from "./map";
import { ink } from "./palette";
import type { Line } from "./plot";

const most = 20000; // points of a line

class Way {
  readonly line: Line;
  private readonly seconds: number[] = [];

  constructor(name: string) {
    this.line = { name, x: [], y: [] };
  }

  clear(): void {
    this.seconds.length = this.line.x.length = this.line.y.length = 0;
  }

  // What lies after it is forgotten: a replay may go back.
  add(second: number, east: number, north: number): void {
    while (this.seconds.length > 0 && this.seconds[this.seconds.length - 1]! >= second) this.drop("pop");
    this.seconds.push(second);
    this.line.x.push(east);
    this.line.y.push(north);
    if (this.seconds.length > most) this.drop("shift");
  }

  private drop(end: "pop" | "shift"): void {
    this.seconds[end]();
    this.line.x[end]();
    this.line.y[end]();
  }
}

export class LiveMap {
  follow = true;

  private readonly map: MapView;
  private readonly truth = new Way("truth");
  private readonly fused = new Way("fused");
  private readonly fixes = new Way("fixes");
  private origin: Geodetic | undefined;
  private state: NavState | undefined;
  private match: MapMatch | undefined;
  private fitted = false;

  constructor(canvas: HTMLCanvasElement, moved: () => void) {
    this.map = new MapView(canvas, true);
    this.map.lines = [this.truth.line, this.fused.line];
    this.map.extra = (map, context) => this.drawVehicle(map, context);
    canvas.addEventListener("pointerdown", moved);
  }

  get points(): number {
    return this.fused.line.x.length;
  }

  load(trail: Trail): void {
    const [latitude, longitude, height] = trail.origin;
    this.begin({ latitude, longitude, height });
    for (const [s, east, north] of trail.fused) this.fused.add(s, east, north);
    for (const [s, east, north] of trail.truth) this.truth.add(s, east, north);
    this.map.redraw();
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
    const [east, north] = [state.position_enu[0]!, state.position_enu[1]!];
    this.fused.add(state.header.stamp_ns * 1e-9, east, north);
    if (!this.fitted) {
      this.map.zoom(6);
      this.fitted = true;
    }
    if (this.follow) this.map.centre(east, north);
    this.map.redraw();
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
    this.map.redraw();
  }

  fit(): void {
    this.map.fit();
  }

  zoom(factor: number): void {
    this.map.zoom(factor);
  }

  private begin(origin: Geodetic): void {
    this.origin = origin;
    for (const way of [this.truth, this.fused, this.fixes]) way.clear();
    this.map.roads = [];
    roads(origin).then(
      (lines) => {
        if (this.origin !== origin) return; // there is a later one
        this.map.roads = lines;
        this.map.redraw();
      },
      () => undefined, // the next origin asks again
    );
  }

  private addTo(way: Way, pose: Pose): void {
    if (!this.origin) return;
    const [east, north] = eastNorth(pose, this.origin);
    way.add(pose.header.stamp_ns * 1e-9, east, north);
    this.map.redraw();
  }

  private drawVehicle(map: MapView, context: CanvasRenderingContext2D): void {
    context.fillStyle = ink("gnss");
    this.fixes.line.x.forEach((east, i) => {
      context.beginPath();
      context.arc(map.x(east!), map.y(this.fixes.line.y[i]!), 3, 0, 2 * Math.PI);
      context.fill();
    });
    if (this.match) this.drawMatch(map, context, this.match);
    if (!this.state) return;
    const x = map.x(this.state.position_enu[0]!);
    const y = map.y(this.state.position_enu[1]!);
    this.drawEllipse(map, context, this.state, x, y);
    context.save();
    context.translate(x, y);
    context.rotate(this.state.azimuth);
    context.fillStyle = ink("fused");
    context.strokeStyle = ink("surface");
    context.lineWidth = 1.5;
    context.beginPath();
    context.moveTo(0, -12);
    context.lineTo(8, 9);
    context.lineTo(0, 5);
    context.lineTo(-8, 9);
    context.closePath();
    context.fill();
    context.stroke();
    context.restore();
  }

  // The point on the road, joined to where the vehicle was thought to be.
  private drawMatch(map: MapView, context: CanvasRenderingContext2D, match: MapMatch): void {
    const x = map.x(match.matched_enu[0]!);
    const y = map.y(match.matched_enu[1]!);
    context.strokeStyle = context.fillStyle = ink("matched");
    context.lineWidth = 1.5;
    context.beginPath();
    context.moveTo(x, y);
    context.lineTo(map.x(match.vehicle_enu[0]!), map.y(match.vehicle_enu[1]!));
    context.stroke();
    context.beginPath();
    context.arc(x, y, 5, 0, 2 * Math.PI);
    context.fill();
  }

  // Three standard deviations.
  private drawEllipse(map: MapView, context: CanvasRenderingContext2D, s: NavState, x: number, y: number): void {
    const [a, b, c] = [s.covariance[0]![0]!, s.covariance[0]![1]!, s.covariance[1]![1]!];
    const middle = (a + c) / 2;
    const half = Math.hypot((a - c) / 2, b);
    const axis = (variance: number) => map.metres(3 * Math.sqrt(Math.max(variance, 0)));
    context.fillStyle = `rgb(from ${ink("fused")} r g b / 0.13)`;
    context.strokeStyle = ink("fused");
    context.lineWidth = 1;
    context.beginPath();
    // The screen's y points down.
    context.ellipse(x, y, axis(middle + half), axis(middle - half), -Math.atan2(2 * b, a - c) / 2, 0, 2 * Math.PI);
    context.fill();
    context.stroke();
  }
}
