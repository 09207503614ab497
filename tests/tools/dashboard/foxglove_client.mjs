// Watches a dashboard as Foxglove does, by Foxglove's own client, and ends the replay that it shows.
//
//   node foxglove_client.mjs [PORT]     without a port it does nothing
//
// Fails if a channel of a replay is missing, or if the replay does not end when it is told to. What the messages contain
// is that of an MCAP file, which other tests look at.
import { createRequire } from "node:module";
import WebSocket from "ws";

const require = createRequire(import.meta.url);
const { FoxgloveClient } = require("@foxglove/ws-protocol");

if (process.argv.length < 3) process.exit(0);
const wanted = ["NAV_STATE", "/map/fix", "/map/pose", "/tf", "/tf_static", "/odom/pose", "/gnss/fix", "/truth/fix", "IMU",
                "VO", "CALIBRATION", "HEALTH", "RUN"];
const fail = (why) => { console.error(why); process.exit(1); };

const client = new FoxgloveClient({
  ws: new WebSocket(`ws://127.0.0.1:${process.argv[2]}`, [FoxgloveClient.SUPPORTED_SUBPROTOCOL]),
});
const channels = new Map(), seen = new Set();
let service, run, asked = false;
client.on("error", (error) => fail(`the connection failed: ${error.message ?? error}`));
client.on("close", () => fail("the connection was closed"));
client.on("status", (status) => fail(`the server warns: ${status.message}`));
client.on("advertiseServices", (services) => { service = services.find((each) => each.name === "/replay/control"); });
client.on("advertise", (list) => {
  for (const channel of list) {
    if (JSON.parse(channel.schema).type !== "object") fail(`${channel.topic} has no schema`);
    channels.set(client.subscribe(channel.id), channel);
  }
});
client.on("serviceCallFailure", (failure) => fail(`the command was refused: ${failure.message}`));
client.on("message", ({ subscriptionId, data }) => {
  const channel = channels.get(subscriptionId), message = JSON.parse(new TextDecoder().decode(data));
  seen.add(channel.topic);
  if (channel.topic === "RUN") {
    run = message.id;
  }
  if (channel.topic === "RUN" && message.ended) {
    if (!asked) fail(`the replay ended without ${wanted.filter((topic) => !seen.has(topic))}`);
    console.log(`${seen.size} channels; the replay ended as it was told`);
    process.exit(0);
  }
  if (!asked && run && service && wanted.every((topic) => seen.has(topic))) {
    asked = true;
    const request = new TextEncoder().encode(JSON.stringify({ run, kind: "quit" }));
    client.sendServiceCallRequest({ serviceId: service.id, callId: 1, encoding: "json", data: new DataView(request.buffer) });
  }
});
setTimeout(() => fail(`not within 60 s: ${wanted.filter((topic) => !seen.has(topic))}; told to end: ${asked}`), 60000);
