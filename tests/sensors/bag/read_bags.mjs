// Reads recordings by libraries that are not maploop's, and writes what they contain as JSON.
//
//   node read_bags.mjs FILE...     .bag, .mcap or .db3
//
// {"FILE": {"seconds": ..., "bytes": ..., "topics": {"/imu": {"type": ..., "encoding": ..., "messages": ...,
// "first": "ns", "last": "ns", "sha256": ...}}}}. The hash is over the stamp (8 bytes, little-endian, ns) and the
// data of each message of the topic, in their order. A topic in one of Foxglove's schemas also has "strange": how one
// of its messages is not what Foxglove itself says of the schema; "" if it is.
import { createHash } from "node:crypto";
import { open, readFile } from "node:fs/promises";
import { createRequire } from "node:module";
import { McapIndexedReader } from "@mcap/core";
import { loadDecompressHandlers } from "@mcap/support";

const require = createRequire(import.meta.url);
const { Bag } = require("@foxglove/rosbag");
const { FileReader } = require("@foxglove/rosbag/node");
const { SqliteSqljs } = require("@foxglove/rosbag2-web");
const foxglove = require("@foxglove/schemas/jsonschema");
const sqlite = require.resolve("@foxglove/sql.js");
await SqliteSqljs.Initialize({ wasmBinary: await readFile(sqlite.replace(/\.js$/, ".wasm")) });
const decompress = await loadDecompressHandlers();

const nanoseconds = (time) => BigInt(time.sec) * 1000000000n + BigInt(time.nsec);

async function* readMcap(file) {
  const handle = await open(file);
  const readable = {
    size: async () => BigInt((await handle.stat()).size),
    read: async (offset, size) => {
      const bytes = new Uint8Array(Number(size));
      await handle.read(bytes, 0, bytes.length, Number(offset));
      return bytes;
    },
  };
  const reader = await McapIndexedReader.Initialize({ readable, decompressHandlers: decompress });
  for await (const message of reader.readMessages()) {
    const channel = reader.channelsById.get(message.channelId);
    const type = reader.schemasById.get(channel.schemaId)?.name ?? "";
    yield [channel.topic, type, channel.messageEncoding, message.logTime, message.data];
  }
  await handle.close();
}

async function* readRos1(file) {
  const bag = new Bag(new FileReader(file), {
    parse: false,
    // Some writers state a size of 1.
    decompress: { bz2: (packed, size) => decompress.bz2(packed, Math.max(size, 1 << 23)), lz4: decompress.lz4 },
  });
  await bag.open();
  for await (const message of bag.messageIterator()) {
    const connection = bag.connections.get(message.connectionId);
    yield [message.topic, connection.type, "ros1", nanoseconds(message.timestamp), message.data];
  }
}

async function* readSqlite(file) {
  const database = new SqliteSqljs(new Uint8Array(await readFile(file)));
  await database.open();
  for await (const { topic, timestamp, data } of database.readMessages()) {
    // This library does not know rosbag2's compression of messages, of whose content the frame states the size.
    const packed = data.length > 4 && Buffer.from(data.subarray(0, 4)).readUInt32LE() === 0xfd2fb528;
    const plain = packed ? decompress.zstd(data, frameSize(data)) : data;
    yield [topic.name, topic.type, topic.serializationFormat, nanoseconds(timestamp), plain];
  }
}

// RFC 8878, 3.1.1.1: a frame of a single segment, or with its window's byte, that states its size.
function frameSize(frame) {
  const bytes = Buffer.from(frame.buffer, frame.byteOffset, frame.byteLength);
  const descriptor = bytes[4];
  const single = (descriptor & 0x20) !== 0;
  const at = 5 + (single ? 0 : 1) + [0, 1, 2, 4][descriptor & 3];
  switch (descriptor >> 6) {
    case 0: return single ? bytes[at] : 1 << 26;
    case 1: return bytes.readUInt16LE(at) + 256;
    case 2: return bytes.readUInt32LE(at);
    default: return Number(bytes.readBigUInt64LE(at));
  }
}

// Returns the first property that a value lacks, or has against its schema; "" if there is none.
function strange(value, schema, path = "") {
  if (schema.oneOf) return schema.oneOf.some((one) => one.const === value) ? "" : `${path} is ${value}`;
  const type = Array.isArray(value) ? "array" : Number.isInteger(value) ? "integer" : typeof value;
  if (type !== schema.type && !(type === "integer" && schema.type === "number")) return `${path} is ${type}`;
  if (type === "array") return value.map((item) => strange(item, schema.items, `${path}[]`)).find(Boolean) ?? "";
  if (type !== "object") return "";
  const names = new Set([...Object.keys(value), ...Object.keys(schema.properties)]);
  for (const name of names) {
    if (!(name in value) && !schema.required.includes(name)) continue;
    if (!(name in value)) return `${path}.${name} is missing`;
    if (!(name in schema.properties)) return `${path}.${name} is not known`;
    const found = strange(value[name], schema.properties[name], `${path}.${name}`);
    if (found) return found;
  }
  return "";
}

const result = {};
for (const file of process.argv.slice(2)) {
  const read = file.endsWith(".bag") ? readRos1 : file.endsWith(".mcap") ? readMcap : readSqlite;
  const topics = new Map();
  const stamp = Buffer.alloc(8);
  const began = process.hrtime.bigint();
  let bytes = 0;
  for await (const [name, type, encoding, time, data] of read(file)) {
    if (!topics.has(name)) {
      topics.set(name, { type, encoding, messages: 0, first: `${time}`, hash: createHash("sha256") });
    }
    const topic = topics.get(name);
    topic.messages += 1;
    if (type.startsWith("foxglove.") && encoding === "json") {
      topic.strange ||= strange(JSON.parse(Buffer.from(data)), foxglove[type.slice("foxglove.".length)]);
    }
    topic.last = `${time}`;
    stamp.writeBigInt64LE(time);
    if (!process.env.WITHOUT_HASH) topic.hash.update(stamp).update(data);
    bytes += data.length;
  }
  const seconds = Number(process.hrtime.bigint() - began) / 1e9;
  result[file] = {
    seconds, bytes,
    topics: Object.fromEntries([...topics].map(
      ([name, { hash, ...rest }]) => [name, { ...rest, sha256: hash.digest("hex") }])),
  };
}
process.stdout.write(JSON.stringify(result));
