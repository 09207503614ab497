// The sky above a receiver: north is up, the horizon outside, rings at 0, 30 and 60 degrees of elevation.
import { ink } from "./palette";

type Place = [x: number, y: number];

// Draws the rings into a square; returns where a direction (rad) is.
export function drawSky(context: CanvasRenderingContext2D, size: number): (azimuth: number, elevation: number) => Place {
  const radius = size / 2 - 26;
  context.strokeStyle = ink("line");
  context.fillStyle = ink("soft");
  context.font = `${size > 400 ? 20 : 13}px system-ui, sans-serif`;
  context.textAlign = "center";
  const place = (azimuth: number, elevation: number): Place => {
    const r = radius * (1 - Math.max(elevation, 0) / (Math.PI / 2));
    return [size / 2 + r * Math.sin(azimuth), size / 2 - r * Math.cos(azimuth)];
  };
  for (const share of [1, 2 / 3, 1 / 3]) {
    context.beginPath();
    context.arc(size / 2, size / 2, share * radius, 0, 2 * Math.PI);
    context.stroke();
  }
  context.fillText("N", size / 2, 20);
  return place;
}

// A dot with the satellite's name above it, in the context's colour.
export function drawSatellite(context: CanvasRenderingContext2D, [x, y]: Place, name: string, radius: number): void {
  context.beginPath();
  context.arc(x, y, radius, 0, 2 * Math.PI);
  context.fill();
  context.fillText(name, x, y - 8 - radius / 2);
}
