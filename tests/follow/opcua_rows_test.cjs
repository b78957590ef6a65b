// The bridge of compensation/control against node-opcua's own server; skipped (77) where node-opcua is not installed (NODE_PATH says where it is).
// node tests/follow/opcua_rows_test.cjs
const {spawn} = require('child_process');
const path = require('path');
let opcua;
try {
  opcua = require('node-opcua');
} catch {
  console.log('no node-opcua here: npm install node-opcua');
  process.exit(77);
}

(async () => {
  const server = new opcua.OPCUAServer({port: 48417, securityPolicies: [opcua.SecurityPolicy.None], securityModes: [opcua.MessageSecurityMode.None]});
  await server.initialize();
  const space = server.engine.addressSpace, own = space.getOwnNamespace();
  const mill = own.addObject({organizedBy: space.rootFolder.objects, browseName: 'mill'});
  const good = value => () => new opcua.Variant({dataType: opcua.DataType.Double, value: value()});
  let speed = 1000;
  own.addVariable({componentOf: mill, nodeId: 's=speed', browseName: 'speed', dataType: 'Double', value: {get: good(() => speed)}});
  own.addVariable({componentOf: mill, nodeId: 's=t01', browseName: 't01', dataType: 'Double', value: {get: () => opcua.StatusCodes.BadSensorFailure}});
  await server.start();
  const bridge = spawn(process.execPath, [path.join(__dirname, '../../compensation/control/opcua_rows.cjs'), 'opc.tcp://127.0.0.1:48417', '0.2',
                                          `speed_rpm=ns=${own.index};s=speed`, `t01_degC=ns=${own.index};s=t01`], {stdio: ['ignore', 'pipe', 'inherit']});
  let text = '';
  const end = (code, words) => { bridge.kill(); console.log(words); process.exit(code); };
  setTimeout(() => end(1, `no rows as they should be: ${text}`), 60000);
  bridge.stdout.on('data', data => {
    text += data;
    const rows = text.split('\n').slice(0, -1).map(JSON.parse);
    if (rows.length === 3) speed = 1500;
    const last = rows.at(-1);
    if (rows.length > 4 && last.speed_rpm === 1500 && last.t01_degC === null && rows[0].speed_rpm === 1000 &&
        Math.abs(last.time_s - Date.now() / 1000) < 10) end(0, `${rows.length} rows, the last ${JSON.stringify(last)}`);
  });
})();
