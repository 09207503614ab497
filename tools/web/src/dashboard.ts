// A running vehicle: its way, its state, how well it keeps its time.
import "../design/tokens.css";
import "../design/base.css";
import "./dashboard.css";

import { Curves } from "./curves";
import { element } from "./dom";
import { Connection, trail, type Verdict } from "./live";
import { LivePlace } from "./live_place";
import { LiveWorld } from "./live_world";
import { themeSwitch } from "./palette";
import { showAids, showDeadlines, showHealth, showPpp, showRoad, showState } from "./panels";
import { PlayerBar } from "./player";
import { RunChoice } from "./runs";
import { Signals } from "./signals";
import { Views } from "./views";

const silent_after = 3000; // ms

const main = element("main", document.body);
const left = element("div", main, "", "left");
const place = element("section", left, "", "place");
const world = new LiveWorld();
new LivePlace(place, world);
const views = new Views(element("section", left, "", "views"));
const signals = new Signals();
new Curves(element("section", left, "", "curves"), signals);
const side = element("aside", main);
side.tabIndex = 0; // so that keys can scroll it
element("h1", side, "maploop", "unseen");
const choiceOfRuns = element("div", side);
const notice = element("div", side, "Connecting…", "notice");
const ended = element("section", side, "", "verdict");
ended.hidden = true;

function panel(title: string): HTMLElement {
  const section = element("section", side);
  element("h2", section, title);
  return element("div", section);
}

const state = panel("State, ± 1 sigma");
const aids = panel("Aids, newest inside");
const road = panel("Road");
road.className = "road";
road.parentElement!.hidden = true; // until a map is matched
const ppp = panel("Precise point positioning");
ppp.parentElement!.hidden = true; // until there are observations
const deadlines = panel("Deadlines");
const health = panel("Health");
const player = new PlayerBar(element("footer", document.body));

themeSwitch(place);

let heardAt = -Infinity;
let isConnected = false;
let verdict: Verdict | null = null;
let runs: RunChoice;

// How the run that is shown has ended.
function showEnd(): void {
  const { shown } = runs;
  ended.hidden = !shown?.ended;
  if (ended.hidden) return;
  ended.replaceChildren();
  element("h2", ended, `Ended: ${shown!.what}`);
  for (const line of verdict?.lines.trimEnd().split("\n") ?? []) element("p", ended, line);
}

function showNotice(): void {
  const silent = performance.now() - heardAt > silent_after;
  notice.textContent = !isConnected
    ? "No connection to maploop dashboard: trying again"
    : runs.isMissing
      ? `There is no run ${runs.pinned} on the bus: choose another, or wait for it`
      : silent
        ? "Nothing comes on the bus: is a replay or a vehicle running?"
        : "";
  document.body.classList.toggle("silent", silent || !isConnected);
}

const connection = new Connection(
  {
    NAV_STATE: (s) => {
      world.addState(s);
      showState(state, s);
      showAids(aids, s);
    },
    TRUTH: (pose) => world.addTruth(pose),
    GNSS_FIX: (fix) => world.addFix(fix),
    MAP_MATCH: (m) => {
      road.parentElement!.hidden = false;
      world.addMatch(m);
      showRoad(road, m);
    },
    PPP_STATE: (p) => {
      ppp.parentElement!.hidden = false;
      showPpp(ppp, p);
      views.showSky(p);
    },
    PREVIEW: (p) => {
      views.showPreview(p);
      world.addScan(p);
    },
    DEADLINES: (d) => showDeadlines(deadlines, d),
    HEALTH: (h) => showHealth(health, h),
    VERDICT: (v) => {
      verdict = v;
      showEnd();
    },
    RUNS: (r) => {
      runs.take(r);
      player.show(runs.shown);
      showNotice();
      showEnd();
    },
  },
  (yes) => {
    isConnected = yes;
    showNotice();
    if (yes && runs.shown) {
      trail(runs.shown.id).then(
        (t) => world.load(t),
        () => undefined, // the trail begins now
      );
    }
  },
  (channel, message) => {
    if (channel === "RUNS") return;
    heardAt = performance.now();
    showNotice();
    signals.take(channel, message);
  },
);
runs = new RunChoice(choiceOfRuns, (run) => connection.show(run));
setInterval(showNotice, 500);
