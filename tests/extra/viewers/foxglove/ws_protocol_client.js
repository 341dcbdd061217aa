// A client of Foxglove's own packages with a robot: prints what it found as JSON. The argument is the server's URL.
// ws-protocol is the client of the protocol, rosmsg reads definitions, rosmsg-serialization reads and writes messages.

const { FoxgloveClient } = require("@foxglove/ws-protocol");
const { parse } = require("@foxglove/rosmsg");
const { MessageReader, MessageWriter } = require("@foxglove/rosmsg-serialization");
const WebSocket = require("ws");

const url = process.argv[2];
const text = new TextEncoder();
const PATIENCE_MS = 50_000;

/** Everything of one kind that has come, and a promise for the first that fits. */
class Came {
  constructor(client, kind) {
    this.all = [];
    this.waiting = [];
    client.on(kind, (event) => {
      this.all.push(event);
      this.waiting = this.waiting.filter(([fits, done]) => !(fits(event) && (done(event), true)));
    });
  }

  first(fits, from = 0) {
    const found = this.all.slice(from).find(fits);
    return found !== undefined ? Promise.resolve(found) : new Promise((done) => this.waiting.push([fits, done]));
  }
}

/** The protocol of those asked for that a server agrees to, or why it agrees to none. */
function protocolOf(asked) {
  return new Promise((done) => {
    const socket = new WebSocket(url, asked);
    socket.on("open", () => (done(socket.protocol), socket.close()));
    socket.on("error", (error) => done(error.message));
  });
}

async function main() {
  const found = {};
  setTimeout(() => {
    console.error("what comes next never came:", found);
    process.exit(1);
  }, PATIENCE_MS).unref();
  const protocol = FoxgloveClient.SUPPORTED_SUBPROTOCOL;
  const both = protocolOf([protocol, "foxglove.sdk.v1"]); // as Foxglove itself asks
  found.protocols = [await protocolOf([protocol]), await both, await protocolOf(["another"])];
  const client = new FoxgloveClient({ ws: new WebSocket(url, [protocol]) });
  const errors = new Came(client, "error");
  const came = {};
  for (const kind of ["serverInfo", "advertise", "advertiseServices", "message", "time", "parameterValues",
    "serviceCallResponse", "serviceCallFailure", "connectionGraphUpdate"]) {
    came[kind] = new Came(client, kind);
  }
  const info = await came.serverInfo.first(() => true);
  found.capabilities = [...info.capabilities].sort();

  const channelOf = async (topic) => {
    const named = (each) => each.topic === topic;
    return (await came.advertise.first((channels) => channels.some(named))).find(named);
  };
  const messages = async (topic) => {
    const channel = await channelOf(topic);
    const reader = channel.encoding === "ros1" ? new MessageReader(parse(channel.schema)) : undefined;
    const decoded = (data) => reader?.readMessage(data) ?? JSON.parse(new TextDecoder().decode(data));
    const id = client.subscribe(channel.id);
    const first = async (fits = () => true) => {
      const is = (event) => event.subscriptionId === id && fits(decoded(event.data));
      return decoded((await came.message.first(is)).data);
    };
    return { channel, id, first };
  };

  const chatter = await messages("/chatter");
  found.channel = [chatter.channel.encoding, chatter.channel.schemaEncoding, chatter.channel.schemaName];
  found.fields = parse(chatter.channel.schema)[0].definitions.map((field) => `${field.type} ${field.name}`);
  found.chatter = (await chatter.first()).data;
  const numbers = (await (await messages("/numbers")).first()).data;
  found.numbers = [numbers.constructor.name, ...numbers].map(String);
  const log = await messages("/cfe/events");
  found.log = [log.channel.encoding, log.channel.schemaEncoding, log.channel.schemaName];

  client.getParameters(["/speed"], "asked");
  const parameters = (id) => came.parameterValues.first((event) => event.id === id);
  found.speed = (await parameters("asked")).parameters;
  client.setParameters([{ name: "/speed", value: 4 }], "set");
  found.faster = (await parameters("set")).parameters;

  const orders = { topic: "/orders", encoding: "ros1", schemaName: "std_msgs/String" };
  const order = client.advertise({ ...orders, schema: "string data", schemaEncoding: "ros1msg" });
  client.sendMessage(order, new MessageWriter(parse("string data")).writeMessage({ data: "loud" }));
  found.loud = (await chatter.first((message) => message.data !== "first")).data;
  const noop = client.advertise({ topic: "/cfe/CFE_ES_NOOP", encoding: "json", schemaName: "" });
  client.sendMessage(noop, text.encode("{}"));
  found.event = (await log.first((event) => event.message.startsWith("No-op"))).name;

  const isSwitch = (service) => service.name === "/switch";
  const service = (await came.advertiseServices.first((each) => each.some(isSwitch))).find(isSwitch);
  const call = (callId, data) =>
    client.sendServiceCallRequest({ serviceId: service.id, callId, encoding: "ros1", data: new Uint8Array([data]) });
  call(1, 1);
  const answer = await came.serviceCallResponse.first((event) => event.callId === 1);
  const response = service.response?.schema ?? service.responseSchema;
  found.on = new MessageReader(parse(response)).readMessage(answer.data);
  call(2, 0);
  found.off = (await came.serviceCallFailure.first((event) => event.callId === 2)).message;

  client.subscribeConnectionGraph();
  const publishers = (name) => (event) => event.publishedTopics.find((topic) => topic.name === name)?.publisherIds;
  const graph = await came.connectionGraphUpdate.first(publishers("/chatter"));
  found.publishers = publishers("/chatter")(graph);
  found.time = typeof (await came.time.first(() => true)).timestamp;

  client.unsubscribe(chatter.id);
  client.unadvertise(order);
  const closed = new Promise((done) => client.on("close", done));
  client.close();
  await closed;
  found.errors = errors.all.map(String);
  console.log(JSON.stringify(found));
}

main().catch((error) => {
  console.error(error);
  process.exit(1);
});
