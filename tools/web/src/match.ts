// The page of `maploop match --html`: roads, fixes and, of the chosen fix, the candidates with their rules.
import "leaflet/dist/leaflet.css";
import "../design/tokens.css";
import "../design/base.css";
import "./match.css";

import L from "leaflet";

import { button, element } from "./dom";
import { ink, onColours, themeSwitch } from "./palette";

type Place = [number, number]; // m east and north

interface Road {
  shape: Place[];
  rank: number; // of its class: 0 is a motorway
  name: string;
}

interface Candidate {
  link: number; // in roads
  at: Place;
  likelihood: number;
  p: number;
  objections: number[]; // in texts
  rules: [number, number][]; // in texts, and weight
}

interface Fix {
  t: number; // s
  place: Place;
  matched?: Place;
  p?: number;
  phase: string;
  explanation: string;
  candidates: Candidate[];
}

interface Data {
  roads: Record<string, Road>;
  fixes: Fix[];
  texts: string[];
}

const tokens = { sure: "good", doubtful: "warning", poor: "error", none: "gnss", candidate: "fused" };

const at = ([east, north]: Place): L.LatLngTuple => [north, east];

function tokenOf(fix: Fix): string {
  if (fix.p === undefined) return tokens.none;
  return fix.p > 0.9 ? tokens.sure : fix.p > 0.6 ? tokens.doubtful : tokens.poor;
}

function widthOf(road: Road): number {
  return road.rank < 4 ? 7 : road.rank < 8 ? 5.5 : road.rank < 10 ? 4.5 : road.rank < 13 ? 3.5 : 2;
}

class MatchPage {
  private readonly map: L.Map;
  private readonly markers: L.CircleMarker[] = [];
  private readonly shown = L.layerGroup();
  private readonly layers: [L.Path, string][] = []; // and their tokens
  private chosen = -1;

  constructor(
    private readonly data: Data,
    place: HTMLElement,
    private readonly details: HTMLElement,
  ) {
    this.map = L.map(place, {
      crs: L.CRS.Simple,
      renderer: L.canvas({ tolerance: 6, padding: 0.3 }),
      minZoom: -7,
      maxZoom: 5,
      zoomSnap: 0.25,
      keyboard: false,
      attributionControl: false,
    });
    L.control.attribution({ prefix: false }).addAttribution("Map data © OpenStreetMap contributors").addTo(this.map);
    L.control.scale({ imperial: false }).addTo(this.map);
    this.fit();
    this.drawRoads();
    this.shown.addTo(this.map);
    this.drawFixes();
    onColours(() => this.repaint());
    document.addEventListener("keydown", (e) => {
      if (e.key === "ArrowRight") this.step(1);
      if (e.key === "ArrowLeft") this.step(-1);
    });
  }

  step(by: number): void {
    const count = this.data.fixes.length;
    if (count === 0) return;
    this.choose(this.chosen < 0 ? (by > 0 ? 0 : count - 1) : (this.chosen + by + count) % count);
    const place = at(this.data.fixes[this.chosen]!.place);
    if (!this.map.getBounds().pad(-0.1).contains(place)) this.map.panTo(place);
  }

  private fit(): void {
    const places = this.data.fixes.map((f) => at(f.place));
    this.map.fitBounds(L.latLngBounds(places.length > 0 ? places : [[0, 0]]).pad(0.05), { maxZoom: 2 });
  }

  private drawRoads(): void {
    const roads = Object.values(this.data.roads);
    const draw = (token: string, grow: number, named: boolean): void => {
      for (const road of roads) {
        const style = { weight: widthOf(road) + grow, interactive: named };
        const line = this.painted(L.polyline(road.shape.map(at), style), token);
        if (named) line.bindTooltip(() => this.plain(road.name), { sticky: true });
      }
    };
    draw("road-edge", 1.6, false);
    draw("road", 0, true);
  }

  // Adds what is drawn in the colour of a token, also after the colours have changed.
  private painted<Layer extends L.Path>(layer: Layer, token: string): Layer {
    this.layers.push([layer, token]);
    return layer.setStyle({ color: ink(token), fillColor: ink(token) }).addTo(this.map);
  }

  private repaint(): void {
    for (const [layer, token] of this.layers) layer.setStyle({ color: ink(token), fillColor: ink(token) });
    if (this.chosen >= 0) this.choose(this.chosen);
  }

  private plain(text: string): HTMLElement {
    const e = document.createElement("span");
    e.textContent = text;
    return e;
  }

  private drawFixes(): void {
    for (const fix of this.data.fixes)
      if (fix.matched) this.painted(L.polyline([at(fix.place), at(fix.matched)], { weight: 1, interactive: false }), "soft");
    this.data.fixes.forEach((fix, i) => {
      const marker = this.painted(L.circleMarker(at(fix.place), { radius: 3.5, stroke: false, fillOpacity: 1 }), tokenOf(fix));
      marker.on("click", () => this.choose(i));
      this.markers.push(marker);
    });
  }

  private choose(i: number): void {
    this.markers[this.chosen]?.setRadius(3.5).setStyle({ stroke: false });
    this.chosen = i;
    const fix = this.data.fixes[i]!;
    this.shown.clearLayers();
    for (const c of [...fix.candidates].reverse()) {
      const road = this.data.roads[c.link];
      if (!road) continue;
      L.polyline(road.shape.map(at), {
        color: ink(tokens.candidate),
        weight: 5,
        opacity: 0.2 + 0.7 * c.p,
        interactive: false,
      }).addTo(this.shown);
      L.circleMarker(at(c.at), { radius: 3, color: ink(tokens.candidate), weight: 2, interactive: false }).addTo(this.shown);
    }
    this.markers[i]!.setRadius(8).setStyle({ stroke: true, color: ink("ink"), weight: 2 }).bringToFront();
    this.describe(fix);
  }

  private describe(fix: Fix): void {
    this.details.replaceChildren();
    element("h2", this.details, `Fix ${this.chosen + 1} of ${this.data.fixes.length}, ${fix.t.toFixed(2)} s, ${fix.phase}`);
    element("p", this.details, fix.explanation);
    const table = element("table", this.details);
    const heading = element("tr", table);
    element("th", heading, "link");
    element("th", heading, "P", "number");
    element("th", heading, "L", "number");
    for (const c of fix.candidates) {
      const row = element("tr", table);
      const link = element("td", row, this.data.roads[c.link]?.name ?? `link ${c.link}`);
      if (c.objections.length > 0)
        element("div", link, c.objections.map((k) => this.data.texts[k]).join("; "), "objections");
      for (const [k, weight] of c.rules) element("div", link, `${weight.toFixed(2)}  ${this.data.texts[k]}`, "rule");
      element("td", row, c.p.toFixed(3), "number");
      element("td", row, c.likelihood.toFixed(0), "number");
    }
    this.details.scrollTop = 0;
  }
}

function legend(parent: HTMLElement): void {
  const keys: [string, string][] = [
    ["P > 0.9", tokens.sure],
    ["> 0.6", tokens.doubtful],
    ["less", tokens.poor],
    ["on no road", tokens.none],
    ["candidates", tokens.candidate],
  ];
  for (const [text, token] of keys) element("span", parent, text).style.setProperty("--key", `var(--${token})`);
}

const text = document.getElementById("match")?.textContent;
if (text) {
  const panel = document.getElementById("panel")!;
  panel.replaceChildren();
  element("h1", panel, "maploop match");
  legend(element("div", panel, "", "legend"));
  const steps = element("div", panel, "", "steps");
  const details = element("div", panel, "", "details");
  details.tabIndex = 0; // so that keys can scroll it
  element("p", details, "Click a fix: its candidates, their probability P, the likelihood L of the rules, and the rules that applied.");
  const page = new MatchPage(JSON.parse(text) as Data, document.getElementById("map")!, details);
  for (const [name, by] of [["‹ before", -1], ["next ›", 1]] as const)
    button(steps, name, by < 0 ? "The fix before" : "The next fix", () => page.step(by));
  themeSwitch(panel);
}
