// The connection to the dashboard's server, and what comes over it: LCM messages by their fields' names.
import type { Geodetic } from "./geodesy";
import type { Line } from "./plot";

export interface Header {
  stamp_ns: number;
}

export interface NavState {
  header: Header;
  status: number; // 0 uninitialized, 1 aided, 2 coasting
  origin_latitude: number; // rad
  origin_longitude: number;
  origin_height: number;
  position_enu: number[];
  velocity_enu: number[];
  azimuth: number; // rad
  pitch: number;
  roll: number;
  covariance: number[][];
  imu_stamp_ns: number;
  odometry_stamp_ns: number;
  gnss_stamp_ns: number;
  wheel_stamp_ns: number;
  odometry_applied: number;
  odometry_refused: number;
}

export interface Pose {
  header: Header;
  latitude: number; // rad
  longitude: number;
  height: number;
}

export interface Fix extends Pose {
  position_covariance: number[][];
}

export interface Candidate {
  road: string;
  way_id: number;
  distance: number | null; // m, of the vehicle
  likelihood: number;
  probability: number;
  rules: string[];
  objections: string[];
}

export interface MapMatch {
  header: Header;
  phase: number;
  on_road: boolean;
  explanation: string;
  p_link: number;
  origin_latitude: number; // rad
  origin_longitude: number;
  matched_enu: number[];
  vehicle_enu: number[];
  cross_track: number;
  lanes: number;
  lane: number;
  p_lane: number;
  candidates: Candidate[];
}

export interface Satellite {
  name: string;
  azimuth: number; // rad
  elevation: number;
  cn0: number; // dB-Hz
  code_used: boolean;
  phase_used: boolean;
  refusal: number;
}

export interface PppState {
  header: Header;
  status: number; // 0 none, 1 converging, 2 converged, 3 fixed
  message: string;
  position_covariance: number[][];
  protection_along: number;
  protection_across: number;
  converging_for: number; // s
  map: number; // 0 none, 1 aiding, 2 paused
  roads_used: number;
  roads_refused: number;
  satellites_used: number;
  satellites: Satellite[];
}

// By ppp_satellite_t.refusal.
export const refusals = [
  "",
  "no code and phase on the carriers used",
  "signal too weak",
  "no orbit or clock, or unhealthy",
  "below the elevation mask",
  "no phase",
  "code far from the others",
  "code does not fit",
  "phase does not fit",
  "Doppler does not fit",
  "no room for its ambiguity",
];

export function satelliteState(s: Satellite): "used" | "partly" | "refused" {
  return s.code_used && s.phase_used ? "used" : s.code_used || s.phase_used ? "partly" : "refused";
}

export interface Preview {
  header: Header;
  width: number; // px; 0: no picture
  height: number;
  jpeg: string; // base64
  track_count: number;
  track_from_u: number[];
  track_from_v: number[];
  track_u: number[];
  track_v: number[];
  scan_stamp_ns: number; // of the points
  point_count: number; // 0: no scan
  point_x: number[]; // cm: forward
  point_y: number[]; // left
  point_z: number[]; // up
}

export interface Latency {
  name: string;
  count: number;
  misses: number;
  deadline_us: number;
  p50_us: number;
  p99_us: number;
  max_us: number;
  guilty: string;
}

export interface Deadlines {
  threads: Latency[];
  paths: Latency[];
}

export interface Health {
  threads: { name: string; scheduling: string; count: number; rate_hz: number; failure: string }[];
  rings: { name: string; lost: number; held: number; capacity: number }[];
  refusals: { stage: string; reason: string; count: number }[];
  outputs: { name: string; sent: number; unsent: number }[];
  degraded: string[];
  elapsed_s: number;
  cpu_s: number;
}

export interface Player {
  paused: boolean;
  seeking: boolean;
  speed: number;
  position_ns: number;
  first_ns: number;
  last_ns: number;
  refused: string;
}

// How a run ended.
export interface Verdict {
  id: string;
  what: string;
  lines: string;
}

// A program that publishes; of a replay with its player's state.
export interface Run {
  id: string;
  what: string;
  ended: boolean;
  player: Player | null;
}

export interface Trail {
  origin: [number, number, number];
  fused: [number, number, number, number][]; // s, east, north, up
  truth: [number, number, number, number][];
}

export interface Messages {
  NAV_STATE: NavState;
  TRUTH: Pose;
  GNSS_FIX: Fix;
  MAP_MATCH: MapMatch;
  PPP_STATE: PppState;
  PREVIEW: Preview;
  DEADLINES: Deadlines;
  HEALTH: Health;
  RUNS: Run[];
  VERDICT: Verdict;
}

type Handlers = { [Channel in keyof Messages]: (message: Messages[Channel]) => void };

// Goes on by itself when the server comes back. `connected` is told of each change, `heard` of each message of any channel.
export class Connection {
  private run = ""; // until it is known: no run
  private source!: EventSource;

  constructor(
    private readonly handlers: Handlers,
    private readonly connected: (yes: boolean) => void,
    private readonly heard: (channel: string, message: unknown) => void,
  ) {
    this.open();
  }

  show(run: string): void {
    if (run === this.run) return;
    this.run = run;
    this.source.close();
    this.open();
  }

  private open(): void {
    const source = (this.source = new EventSource(`/events?${new URLSearchParams({ run: this.run })}`));
    source.onopen = () => this.connected(true);
    source.onerror = () => {
      this.connected(false);
      // A server that answered with an error is not asked again by the browser itself.
      if (source.readyState !== EventSource.CLOSED) return;
      source.close();
      setTimeout(() => source === this.source && this.open(), 2000);
    };
    source.onmessage = (event: MessageEvent<string>) => {
      const { channel, message } = JSON.parse(event.data) as { channel: keyof Messages; message: never };
      this.heard(channel, message);
      this.handlers[channel]?.(message);
    };
  }
}

// Throws an Error that says why it was refused.
export async function command(run: string, kind: string, value = 0): Promise<void> {
  const answer = await fetch("/control", { method: "POST", body: JSON.stringify({ run, kind, value }) });
  if (!answer.ok) {
    const said = (await answer.json().catch(() => ({}))) as { refused?: string };
    throw new Error(said.refused ?? `the server answered ${answer.status}`);
  }
}

// The map's roads about an origin, in metres.
export async function roads(origin: Geodetic): Promise<Line[]> {
  const { latitude, longitude, height } = origin;
  const answer = await fetch(`/roads?latitude=${latitude}&longitude=${longitude}&height=${height}`);
  return answer.ok ? ((await answer.json()) as { roads: Line[] }).roads : [];
}

export async function trail(run: string): Promise<Trail> {
  return (await (await fetch(`/trail?${new URLSearchParams({ run })}`)).json()) as Trail;
}
