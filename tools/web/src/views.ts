// What the vehicle sees, beneath the map: its camera with the features it follows, its LiDAR from above, and
// the sky of its GNSS receiver.
import { element } from "./dom";
import { refusals, satelliteState, type PppState, type Preview } from "./live";
import { ink } from "./palette";
import { drawSatellite, drawSky } from "./sky";

export const stateTokens = { used: "good", partly: "warning", refused: "error" } as const;

// A picture with its caption, there from the first time that it is drawn.
class View {
  readonly canvas: HTMLCanvasElement;
  private readonly figure: HTMLElement;
  private readonly caption: HTMLElement;

  constructor(parent: HTMLElement, name: string) {
    this.figure = element("figure", parent, "", `view ${name}`);
    this.figure.hidden = true;
    this.caption = element("figcaption", this.figure);
    this.canvas = element("canvas", this.figure) as HTMLCanvasElement;
    this.canvas.setAttribute("role", "img");
    this.canvas.setAttribute("aria-label", name);
  }

  // A context of `width` by `height`, cleared.
  begin(width: number, height: number, caption: string): CanvasRenderingContext2D {
    this.figure.hidden = false;
    this.figure.parentElement!.hidden = false;
    this.caption.textContent = caption;
    if (this.canvas.width !== width || this.canvas.height !== height) {
      this.canvas.width = width;
      this.canvas.height = height;
    }
    const context = this.canvas.getContext("2d")!;
    context.clearRect(0, 0, width, height);
    return context;
  }
}

export class Views {
  private readonly camera: View;
  private readonly scan: View;
  private readonly sky: View;
  private shown = 0; // stamp of the newest picture asked for

  constructor(parent: HTMLElement) {
    parent.hidden = true;
    this.camera = new View(parent, "camera");
    this.scan = new View(parent, "scan");
    this.sky = new View(parent, "sky");
  }

  showPreview(p: Preview): void {
    if (p.width > 0) this.decode(p);
    if (p.point_count > 0) this.drawScan(p);
  }

  // Decoding takes a while: a later picture may have come meanwhile.
  private decode(p: Preview): void {
    const stamp = (this.shown = p.header.stamp_ns);
    const image = new Image();
    image.onload = () => {
      if (stamp === this.shown) this.drawCamera(p, image);
    };
    image.src = `data:image/jpeg;base64,${p.jpeg}`;
  }

  private drawCamera(p: Preview, image: HTMLImageElement): void {
    const context = this.camera.begin(p.width, p.height, `Camera, ${p.track_count} features followed`);
    context.drawImage(image, 0, 0);
    context.strokeStyle = context.fillStyle = ink("feature");
    context.lineWidth = 1.2;
    p.track_u.forEach((u, i) => {
      const v = p.track_v[i]!;
      context.beginPath();
      context.moveTo(p.track_from_u[i]!, p.track_from_v[i]!);
      context.lineTo(u, v);
      context.stroke();
      context.fillRect(u - 1, v - 1, 2, 2);
    });
  }

  // Forward is up; what stands out more is higher.
  private drawScan(p: Preview): void {
    const [size, reach] = [480, 40]; // px, m
    const context = this.scan.begin(size, size, "Scan from above, rings of 10 m");
    const scale = size / 2 / reach;
    context.strokeStyle = ink("line");
    for (let r = 10; r <= reach; r += 10) {
      context.beginPath();
      context.arc(size / 2, size / 2, r * scale, 0, 2 * Math.PI);
      context.stroke();
    }
    for (let i = 0; i < p.point_count; ++i) {
      const x = size / 2 - 0.01 * p.point_y[i]! * scale;
      const y = size / 2 - 0.01 * p.point_x[i]! * scale;
      const height = Math.min(Math.max((0.01 * p.point_z[i]! + 1.5) / 4, 0), 1);
      context.fillStyle = ink(`ramp-${1 + Math.round(4 * height)}`);
      context.fillRect(x - 1, y - 1, 2, 2);
    }
    context.fillStyle = ink("fused");
    context.fillRect(size / 2 - 0.9 * scale, size / 2 - 2.2 * scale, 1.8 * scale, 4.4 * scale);
  }

  showSky(p: PppState): void {
    const size = 480;
    const used = p.satellites.filter((s) => satelliteState(s) === "used").length;
    const context = this.sky.begin(size, size, `Sky: ${used} of ${p.satellites.length} satellites used in full`);
    const place = drawSky(context, size);
    for (const s of p.satellites) {
      if (s.azimuth === 0 && s.elevation === 0) continue; // no ephemeris
      context.fillStyle = ink(stateTokens[satelliteState(s)]);
      drawSatellite(context, place(s.azimuth, s.elevation), s.name, 4 + Math.max(0, s.cn0 - 25) / 5);
    }
    this.sky.canvas.title = p.satellites.map((s) => `${s.name}: ${refusals[s.refusal] || "used"}`).join("\n");
  }
}
