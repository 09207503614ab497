// WGS84 to metres east and north of an origin, and above it.

const a = 6378137.0; // m
const e2 = 6.69437999014e-3;

function ecef(latitude: number, longitude: number, height: number): [number, number, number] {
  const n = a / Math.sqrt(1 - e2 * Math.sin(latitude) ** 2);
  return [
    (n + height) * Math.cos(latitude) * Math.cos(longitude),
    (n + height) * Math.cos(latitude) * Math.sin(longitude),
    (n * (1 - e2) + height) * Math.sin(latitude),
  ];
}

export interface Geodetic {
  latitude: number; // rad
  longitude: number;
  height: number; // m
}

export function enu(p: Geodetic, origin: Geodetic): [number, number, number] {
  const [x, y, z] = ecef(p.latitude, p.longitude, p.height);
  const [x0, y0, z0] = ecef(origin.latitude, origin.longitude, origin.height);
  const [dx, dy, dz] = [x - x0, y - y0, z - z0];
  const [sf, cf] = [Math.sin(origin.latitude), Math.cos(origin.latitude)];
  const [sl, cl] = [Math.sin(origin.longitude), Math.cos(origin.longitude)];
  return [-sl * dx + cl * dy, -sf * cl * dx - sf * sl * dy + cf * dz, cf * cl * dx + cf * sl * dy + sf * dz];
}
