// Starts dashboards and replays for the tests of the dashboard, and opens its page.
import assert from "node:assert/strict";
import { spawn } from "node:child_process";
import { join } from "node:path";

import { maploop, newPage } from "./pages.mjs";

export const drive = join(process.env.MAPLOOP_CACHE, "2011_09_26/2011_09_26_drive_0013_sync");

const children = [];

export function start(...args) {
  const child = spawn(maploop, args, { stdio: ["ignore", "pipe", "ignore"] });
  children.push(child);
  return child;
}

export function killAll() {
  for (const child of children) child.kill("SIGKILL");
}

export async function firstLine(child) {
  for await (const data of child.stdout) return String(data).split("\n")[0];
  return "";
}

// A dashboard with the address of its page.
export async function startDashboard(...args) {
  const child = start("dashboard", "--port", "0", ...args);
  return { child, url: (await firstLine(child)).split(" ")[0] };
}

export async function stop(child) {
  const ended = new Promise((resolve) => child.once("exit", resolve));
  child.kill("SIGINT");
  await ended;
}

// A page that fails the test when its script does.
export async function openLive(browser, url, viewport, colorScheme = "light") {
  const page = await newPage(browser, { viewport, colorScheme });
  page.on("pageerror", (e) => assert.fail(`the page's script failed: ${e}`));
  await page.goto(url);
  return page;
}
