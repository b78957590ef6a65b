#!/usr/bin/env node
// Nodes of an OPC UA server (umati, MTConnect's gateway, a PLC) as rows for `driftwright follow`. Needs node-opcua: npm install node-opcua
//
//     opcua_rows.cjs opc.tcp://mill:4840 1 speed_rpm='ns=1;s=speed' t01_degC='ns=1;s=t01' | driftwright follow observer.json
//
// The second word is the time from row to row in seconds. A node whose status is not good is missing.
console.log = console.error;  // node-opcua talks there; rows alone go to standard output
const {AttributeIds, OPCUAClient} = require('node-opcua');
const [address, every_s, ...channels] = process.argv.slice(2);
const items = channels.map(c => ({name: c.slice(0, c.indexOf('=')), nodeId: c.slice(c.indexOf('=') + 1), attributeId: AttributeIds.Value}));

(async () => {
  const client = OPCUAClient.create({endpointMustExist: false, connectionStrategy: {maxRetry: -1, initialDelay: 1000, maxDelay: 10000}});
  await client.connect(address);
  const session = await client.createSession();
  process.stdout.on('error', () => process.exit(0));  // follow has ended
  for (;;) {
    const due = Date.now() + 1000 * Number(every_s);
    const values = await session.read(items).catch(() => []);  // the client connects again by itself; no row meanwhile
    const row = values.map((v, i) => [items[i].name, v.statusCode.isGood() && Number.isFinite(Number(v.value.value)) ? Number(v.value.value) : null]);
    if (row.length > 0) process.stdout.write(JSON.stringify({time_s: Date.now() / 1000, ...Object.fromEntries(row)}) + '\n');
    await new Promise(wait => setTimeout(wait, Math.max(0, due - Date.now())));
  }
})().catch(e => { console.error(`opcua_rows: ${e.message}`); process.exit(2); });
