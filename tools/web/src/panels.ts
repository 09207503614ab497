// The panels beside the map.
import { element, table } from "./dom";
import {
  refusals,
  satelliteState,
  type Deadlines,
  type Health,
  type Latency,
  type MapMatch,
  type NavState,
  type PppState,
} from "./live";
import { stateTokens } from "./views";

const statuses = ["waiting for a first fix", "aided", "coasting", "position only, no course yet"];

function degrees(radians: number): number {
  return (radians * 180) / Math.PI;
}

function age(now: number, stamp: number): string {
  return stamp === 0 ? "never" : `${((now - stamp) * 1e-9).toFixed(2)} s ago`;
}

export function showState(panel: HTMLElement, s: NavState): void {
  const sigma = (i: number) => Math.sqrt(s.covariance[i]?.[i] ?? NaN);
  const speed = Math.hypot(s.velocity_enu[0]!, s.velocity_enu[1]!);
  table(panel, [], [
    ["status", statuses[s.status] ?? `${s.status}`],
    ["speed", `${(3.6 * speed).toFixed(1)} km/h`],
    ["azimuth", `${((degrees(s.azimuth) + 360) % 360).toFixed(1)}° ± ${degrees(sigma(6)).toFixed(2)}°`],
    ["pitch, roll", `${degrees(s.pitch).toFixed(1)}°, ${degrees(s.roll).toFixed(1)}°`],
    ["east", `${s.position_enu[0]!.toFixed(2)} ± ${sigma(0).toFixed(2)} m`],
    ["north", `${s.position_enu[1]!.toFixed(2)} ± ${sigma(1).toFixed(2)} m`],
    ["up", `${s.position_enu[2]!.toFixed(2)} ± ${sigma(2).toFixed(2)} m`],
  ]);
  panel.dataset["status"] = `${s.status}`;
}

export function showAids(panel: HTMLElement, s: NavState): void {
  const now = s.header.stamp_ns;
  table(panel, [], [
    ["inertial", age(now, s.imu_stamp_ns)],
    ["odometry", age(now, s.odometry_stamp_ns)],
    ["GNSS", age(now, s.gnss_stamp_ns)],
    ["wheels", age(now, s.wheel_stamp_ns)],
    ["odometry used, refused", `${s.odometry_applied}, ${s.odometry_refused}`],
  ]);
}

const phases = ["looking for the first link", "along the link", "at a junction", "off road"];

export function showRoad(panel: HTMLElement, m: MapMatch): void {
  const rows = m.candidates.slice(0, 6).map((c) => {
    const road = document.createElement("span");
    road.textContent = c.road || `way ${c.way_id}`;
    road.title = [...c.objections, ...c.rules].join("\n");
    return [road, c.probability.toFixed(3), c.likelihood.toFixed(0), c.objections[0] ?? ""];
  });
  table(panel, ["link", "P", "rules", "against it"], rows);
  const p = document.createElement("p");
  const lane = m.on_road && m.lanes > 0 ? `; lane ${m.lane} of ${m.lanes}, P ${m.p_lane.toFixed(2)}` : "";
  p.textContent = `${phases[m.phase] ?? ""}: ${m.explanation}${lane}`;
  panel.prepend(p);
}

const solutions = ["no position", "converging", "converged", "fixed"];
const maps = ["says nothing yet", "corrects it across the road", "is left out for a while: it was a wrong road"];

export function showPpp(panel: HTMLElement, p: PppState): void {
  const sigma = (i: number) => Math.sqrt(p.position_covariance[i]?.[i] ?? NaN);
  const satellites = [...p.satellites]
    .sort((a, b) => b.elevation - a.elevation)
    .map((s) => {
      const state = satelliteState(s);
      const dot = document.createElement("span");
      dot.textContent = `● ${s.name}`;
      dot.className = stateTokens[state];
      return [dot, `${degrees(s.elevation).toFixed(0)}°`, s.cn0.toFixed(0), refusals[s.refusal] || state];
    });
  const list = document.createElement("div");
  list.className = "satellites";
  table(list, ["", "elevation", "dB-Hz", "used, or why not"], satellites);
  const rows = [["position", `${solutions[p.status] ?? ""} for ${p.converging_for.toFixed(0)} s`]];
  if (p.status > 0) {
    rows.push(["sigma east, north, up", `${sigma(0).toFixed(2)}, ${sigma(1).toFixed(2)}, ${sigma(2).toFixed(2)} m`]);
    rows.push(["protection along, across", `${p.protection_along.toFixed(1)}, ${p.protection_across.toFixed(1)} m`]);
  }
  rows.push(["road map", maps[p.map] ?? ""]);
  if (p.roads_used + p.roads_refused > 0) {
    rows.push(["roads used, refused", `${p.roads_used}, ${p.roads_refused}`]);
  }
  table(panel, [], rows);
  if (p.message) element("p", panel, p.message);
  panel.append(list);
}

// A bar to the deadline: half of all, 99 of 100, the longest.
function strip(l: Latency): HTMLElement {
  const bar = document.createElement("div");
  bar.className = "strip";
  const scale = l.deadline_us > 0 ? l.deadline_us : Math.max(l.max_us, 1);
  for (const [kind, value] of [["max", l.max_us], ["p99", l.p99_us], ["p50", l.p50_us]] as const) {
    const part = element("i", bar, "", kind);
    part.style.width = `${Math.min(100, (100 * value) / scale)}%`;
  }
  bar.title = `p50 ${ms(l.p50_us)}, p99 ${ms(l.p99_us)}, max ${ms(l.max_us)}, deadline ${ms(l.deadline_us)}`;
  return bar;
}

function ms(us: number): string {
  return `${(us / 1000).toPrecision(3)} ms`;
}

export function showDeadlines(panel: HTMLElement, d: Deadlines): void {
  const rows = [...d.threads, ...d.paths].map((l) => {
    const misses = document.createElement("span");
    misses.textContent = `${l.misses} of ${l.count}`;
    misses.className = l.misses > 0 ? "error" : "";
    if (l.guilty !== "") misses.title = `the worst: ${l.guilty}`;
    return [l.name, strip(l), ms(l.p99_us), misses];
  });
  table(panel, ["", "up to the deadline", "p99", "missed"], rows);
}

export function showHealth(panel: HTMLElement, h: Health): void {
  const lost = h.rings.reduce((sum, ring) => sum + ring.lost, 0);
  const unsent = h.outputs.reduce((sum, output) => sum + output.unsent, 0);
  const cpu = h.elapsed_s > 0 ? ((100 * h.cpu_s) / h.elapsed_s).toFixed(0) : "-";
  const rows = h.threads.map((t) => [t.name, t.failure || `${t.rate_hz.toFixed(1)} Hz`, t.scheduling]);
  table(panel, ["thread", "rate", "scheduling"], rows);
  element("p", panel, `${cpu} % of one processor; ${lost} samples lost in rings, ${unsent} messages unsent`);
  const list = element("ul", panel);
  for (const sentence of h.degraded) element("li", list, sentence, "error");
  for (const r of h.refusals) element("li", list, `${r.stage} did not use ${r.count}: ${r.reason}`);
}
