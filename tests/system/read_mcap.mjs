// Reads an MCAP file by its index with @mcap/core, validates each message against its schema and
// against that of @foxglove/schemas, and compares what it holds with a run's summary.json.
// node read_mcap.mjs FILE RUN_FOLDER, with the packages in node_modules/ of the working folder.
import { readFileSync, openSync, readSync, fstatSync } from "node:fs";
import { createRequire } from "node:module";
import { isDeepStrictEqual } from "node:util";

const require = createRequire(process.cwd() + "/");
const { McapIndexedReader, McapStreamReader } = require("@mcap/core");
const published = require("@foxglove/schemas/jsonschema");

const [file, folder] = process.argv.slice(2);
const fail = (what) => { console.error("read_mcap: " + what); process.exit(1); };
const expect = (found, wanted, what) => {
  if (!isDeepStrictEqual(found, wanted)) fail(`${what}: found ${found}, must be ${wanted}`);
};

const types = {
  object: (v) => typeof v === "object" && v !== null && !Array.isArray(v),
  array: Array.isArray,
  string: (v) => typeof v === "string",
  number: (v) => typeof v === "number",
  integer: Number.isInteger,
  boolean: (v) => typeof v === "boolean",
};
function validate(value, rule, place) {
  if (rule.type && !types[rule.type](value)) fail(`${place} is no ${rule.type}`);
  if (rule.oneOf && !rule.oneOf.some((choice) => choice.const === value)) fail(`${place} is ${value}`);
  if (rule.minimum !== undefined && value < rule.minimum) fail(`${place} is below ${rule.minimum}`);
  if (Array.isArray(value)) {
    if (value.length < (rule.minItems ?? 0)) fail(`${place} has too few entries`);
    if (value.length > (rule.maxItems ?? Infinity)) fail(`${place} has too many entries`);
    value.forEach((entry) => validate(entry, rule.items, place + "[]"));
  } else if (rule.type === "object") {
    for (const name of rule.required ?? []) if (!(name in value)) fail(`${place}.${name} is missing`);
    for (const name of Object.keys(value)) {
      if (!rule.properties[name]) fail(`${place}.${name} is unknown`);
      validate(value[name], rule.properties[name], place + "." + name);
    }
  }
}

class ReadableFile {
  constructor(path) { this.descriptor = openSync(path); this.bytesRead = 0; }
  async size() { return BigInt(fstatSync(this.descriptor).size); }
  async read(offset, length) {
    const buffer = new Uint8Array(Number(length));
    const got = readSync(this.descriptor, buffer, 0, buffer.length, Number(offset));
    if (got !== buffer.length) fail(`the file ends early at ${offset}`);
    this.bytesRead += got;
    return buffer;
  }
}

const readable = new ReadableFile(file);
const reader = await McapIndexedReader.Initialize({ readable });
if (readable.bytesRead > 1_000_000) fail(`${readable.bytesRead} bytes were read to find the index`);
for (const schema of reader.schemasById.values()) {
  const own = JSON.parse(new TextDecoder().decode(schema.data));
  const wanted = published[schema.name.replace("foxglove.", "")];
  expect(schema.encoding, "jsonschema", schema.name);
  if (!isDeepStrictEqual(own, wanted)) fail(`${schema.name} is not the published schema`);
}

const topics = new Map();
let last = -1n;
for await (const message of reader.readMessages()) {
  const channel = reader.channelsById.get(message.channelId);
  const schema = reader.schemasById.get(channel.schemaId);
  const value = JSON.parse(new TextDecoder().decode(message.data));
  validate(value, published[schema.name.replace("foxglove.", "")], channel.topic);
  if (message.logTime < last) fail(`${channel.topic}: the index is not in order of time`);
  last = message.logTime;
  const topic = topics.get(channel.topic) ?? { count: 0, schema: schema.name };
  topics.set(channel.topic, { ...topic, count: topic.count + 1, value, time: message.logTime });
  if (schema.name === "foxglove.CompressedImage") {
    const jpeg = Buffer.from(value.data, "base64");
    if (jpeg.readUInt16BE(0) !== 0xffd8 || jpeg.readUInt16BE(jpeg.length - 2) !== 0xffd9)
      fail(`${channel.topic}: no JPEG`);
  }
}
for (const [channel, count] of reader.statistics.channelMessageCounts)
  expect(BigInt(topics.get(reader.channelsById.get(channel).topic)?.count ?? 0), count, `channel ${channel}`);

// The same messages from the beginning to the end, every checksum verified.
const stream = new McapStreamReader({ validateCrcs: true });
stream.append(readFileSync(file));
let streamed = 0n;
for (let record; (record = stream.nextRecord()); ) if (record.type === "Message") ++streamed;
if (!stream.done()) fail("the stream does not end");
expect(streamed, reader.statistics.messageCount, "messages in the stream");

const summary = JSON.parse(readFileSync(folder + "/summary.json"));
const lines = (name) => readFileSync(`${folder}/${name}`, "utf8").trim().split("\n");
const ticks = lines("ticks.csv").length - 1;
const end = topics.get("/truth/pose");
expect(Number(end.time), Math.round(summary.sim_s * 1e9), "the mission's end in ns");
expect(end.count, ticks, "true poses");
const ends_as = (name, at) => {
  const [x, y, z] = lines(name + ".tum").at(-1).split(" ").slice(1, 4).map(Number);
  if (Math.hypot(at.x - x, at.y - y, at.z - z) > 2e-6)
    fail(`${name} ends at ${at.x} ${at.y} ${at.z}, must be ${x} ${y} ${z}`);
};
const at = end.value.pose.position;
ends_as("truth", at);
for (const [name, figures] of Object.entries(summary.localizers)) {
  const topic = topics.get(`/localizers/${name}/pose`);
  expect(topic.count, ticks, `poses of ${name}`);
  expect(topics.get(`/localizers/${name}/odometry`).count, ticks, `odometry of ${name}`);
  const p = topic.value.pose.position;
  ends_as(name, p);
  // On ramps the summary's error is that in the plan.
  const error_m = Math.hypot(p.x - at.x, p.y - at.y);
  if (!figures.in_space && at.z === 0 && Math.abs(error_m - figures.position_final_m) > 1e-5)
    fail(`${name} ends ${error_m} m off, must be ${figures.position_final_m}`);
}
expect(topics.get("/events").count, lines("events.jsonl").length - 1, "events but the start");
const cameras = [...topics.keys()].filter((name) => name.endsWith("/image"));
if (cameras.length === 0) fail("no camera");
for (const name of cameras) {
  const images = topics.get(name).count;
  const wanted = Math.floor(summary.sim_s * 5);
  if (Math.abs(images - wanted) > 1 + 0.02 * wanted) fail(`${name}: ${images} pictures, must be about ${wanted}`);
  expect(topics.get(name.replace("image", "annotations")).count, images, "annotations of " + name);
}
console.log(`${reader.statistics.messageCount} messages in ${reader.chunkIndexes.length} chunks, ` +
            `${topics.size} topics, ${ticks} ticks: as summary.json has them`);
