// Whether those who look on slow the vehicle down: a drive at real-time rate, alone, with the dashboard's
// server, and with three browsers at it, in turn.
//
//   in-a-browser FOLDER MAPLOOP watched_replay.mjs [ROUNDS]
//
// The browsers are on the same machine at nice 19, as those of another machine would not be.
import { spawn, spawnSync } from "node:child_process";
import { readFileSync, writeFileSync } from "node:fs";
import { join } from "node:path";

import { chromium } from "playwright-core";

const [maploop, folder, browserPath, rounds = "3"] = process.argv.slice(2);
const drive = join(process.env.MAPLOOP_CACHE, "2011_09_26/2011_09_26_drive_0013_sync");
const result = join(folder, "watched.json");
const executablePath = join(folder, "quiet-browser");
writeFileSync(executablePath, `#!/bin/sh\nexec nice -n 19 ${browserPath} "$@"\n`, { mode: 0o755 });

// Of one replay: how much of a core it took, and for each thread how often it missed its deadline.
async function replay(browsers) {
  const started = performance.now();
  const child = spawn(maploop, ["replay", drive, "--json", result], { stdio: "ignore" });
  const ended = new Promise((resolve) => child.once("exit", resolve));
  // "aided" stands beside the vehicle's first state.
  const first = browsers[0]?.getByText("aided").waitFor({ timeout: 30000 }).then(() => performance.now() - started);
  const status = await ended;
  if (status !== 0) throw new Error(`maploop replay ended with ${status}`);
  const said = JSON.parse(readFileSync(result));
  const threads = Object.fromEntries(
    Object.entries(said.deadlines.threads).map(([name, t]) => [name, `${t.misses} of ${t.count}, p99 ${t.p99_ms.toFixed(1)} ms`]));
  return { cpu_s: said.replay.cpu_s, first_state_ms: await first, threads };
}

async function watched(count) {
  if (count === undefined) return replay([]);
  const server = spawn(maploop, ["dashboard", "--port", "0"], { stdio: ["ignore", "pipe", "ignore"] });
  let url;
  for await (const data of server.stdout) {
    url = String(data).split(" ")[0];
    break;
  }
  const browsers = [];
  const pages = [];
  for (let i = 0; i < count; ++i) {
    browsers.push(await chromium.launch({ executablePath, args: ["--no-sandbox", "--disable-gpu"] }));
    pages.push(await browsers[i].newPage({ viewport: { width: 1280, height: 860 } }));
    await pages[i].goto(url);
  }
  const said = await replay(pages);
  if (count > 0) await pages[0].screenshot({ path: join(folder, "watched.png") });
  for (const browser of browsers) await browser.close();
  server.kill("SIGINT");
  return said;
}

spawnSync(maploop, ["replay", drive, "--lockstep", "--no-lcm"]); // files into memory
for (let round = 0; round < Number(rounds); ++round) {
  for (const [name, count] of [["alone", undefined], ["server", 0], ["3 browsers", 3]]) {
    console.log(name.padEnd(11), JSON.stringify(await watched(count)));
  }
}
