// The map of the dashboard: where the vehicle has been and is, and how sure of it it is.
import type { MapMatch, NavState } from "./live";
import type { LiveWorld } from "./live_world";
import { MapView } from "./map";
import { ink } from "./palette";

export class LiveMap {
  follow = true;

  private readonly map: MapView;
  private fitted = false;

  constructor(
    canvas: HTMLCanvasElement,
    private readonly world: LiveWorld,
    moved: () => void,
  ) {
    this.map = new MapView(canvas, true);
    this.map.lines = [world.truth.line, world.fused.line];
    this.map.extra = (map, context) => this.drawVehicle(map, context);
    canvas.addEventListener("pointerdown", moved);
    world.onChange(() => this.refresh());
  }

  fit(): void {
    this.map.fit();
  }

  zoom(factor: number): void {
    this.map.zoom(factor);
  }

  private refresh(): void {
    const { state, roads } = this.world;
    this.map.roads = roads;
    if (state && !this.fitted) {
      this.map.zoom(6);
      this.fitted = true;
    }
    if (state && this.follow) this.map.centre(state.position_enu[0]!, state.position_enu[1]!);
    this.map.redraw();
  }

  private drawVehicle(map: MapView, context: CanvasRenderingContext2D): void {
    const { fixes, match, state } = this.world;
    context.fillStyle = ink("gnss");
    fixes.line.x.forEach((east, i) => {
      context.beginPath();
      context.arc(map.x(east!), map.y(fixes.line.y[i]!), 3, 0, 2 * Math.PI);
      context.fill();
    });
    if (match) this.drawMatch(map, context, match);
    if (!state) return;
    const x = map.x(state.position_enu[0]!);
    const y = map.y(state.position_enu[1]!);
    this.drawEllipse(map, context, state, x, y);
    context.save();
    context.translate(x, y);
    context.rotate(state.azimuth);
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
