// Prints what the public MAVLink implementation node-mavlink makes of the messages of autopilot_test.cpp, as JSON from
// name to hexadecimal bytes. node_mavlink_vectors.json is its output with node-mavlink 2.3.0 and mavlink-mappings
// 1.0.21. To look again: npm install node-mavlink; NODE_PATH=$PWD/node_modules node node_mavlink.cjs. With a file as
// argument it prints nothing, and fails where the file says otherwise.
"use strict";

const assert = require("node:assert/strict");
const { readFileSync } = require("node:fs");

let mavlink;
try {
  mavlink = require("node-mavlink");
} catch (error) {
  console.error("node-mavlink is not installed: nothing is checked");
  process.exit(77);
}
const { common, MavLinkProtocolV2 } = mavlink;
const { MavLinkData, MavLinkPacketField } = require("mavlink-mappings");

// Not in mavlink-mappings yet, which has the older GLOBAL_POSITION of development.xml under that number.
class GlobalPositionSensor extends MavLinkData {}
GlobalPositionSensor.MSG_ID = 296;
GlobalPositionSensor.MSG_NAME = "GLOBAL_POSITION_SENSOR";
GlobalPositionSensor.PAYLOAD_LENGTH = 41;
GlobalPositionSensor.MAGIC_NUMBER = 158;
GlobalPositionSensor.FIELDS = [
  ["time_usec", "timeUsec", 0, 8, "uint64_t"],
  ["processing_time", "processingTime", 8, 4, "uint32_t"],
  ["lat", "lat", 12, 4, "int32_t"],
  ["lon", "lon", 16, 4, "int32_t"],
  ["alt_ellipsoid", "altEllipsoid", 20, 4, "float"],
  ["alt", "alt", 24, 4, "float"],
  ["eph", "eph", 28, 4, "float"],
  ["epv", "epv", 32, 4, "float"],
  ["target_system", "targetSystem", 36, 1, "uint8_t"],
  ["target_component", "targetComponent", 37, 1, "uint8_t"],
  ["id", "id", 38, 1, "uint8_t"],
  ["source", "source", 39, 1, "uint8_t"],
  ["flags", "flags", 40, 1, "uint8_t"],
].map(([source, name, offset, size, type]) => new MavLinkPacketField(source, name, offset, false, size, type, ""));

const gpsInput = {
  timeUsec: 1763724896250000n, gpsId: 0, timeWeekMs: 473714250, timeWeek: 2393, lat: 377632123, lon: -1222571987,
  hdop: 0, vdop: 0, vn: 0, ve: 0, vd: 0, speedAccuracy: 0, vertAccuracy: 0,
};

const messages = {
  gps_input_3d: [new common.GpsInput(), {
    ...gpsInput, alt: 512.25, horizAccuracy: 2.5, ignoreFlags: 190, fixType: 3, satellitesVisible: 10, yaw: 13140,
  }],
  gps_input_2d: [new common.GpsInput(), {
    ...gpsInput, alt: 0, horizAccuracy: 0, ignoreFlags: 255, fixType: 2, satellitesVisible: 0, yaw: 36000,
  }],
  gps_input_none: [new common.GpsInput(), {
    ...gpsInput, timeUsec: 12000000n, timeWeekMs: 0, timeWeek: 0, lat: 0, lon: 0, alt: 0, horizAccuracy: 0,
    ignoreFlags: 255, fixType: 1, satellitesVisible: 0, yaw: 0,
  }],
  command_int: [new common.CommandInt(), {
    targetSystem: 7, targetComponent: 1, frame: 0, command: 43003, current: 0, autocontinue: 0, _param1: 146.5,
    _param2: 0.25, _param3: 2.5, _param4: 0, _param5: 377632123, _param6: -1222571987, _param7: NaN,
  }],
  command_int_unknown: [new common.CommandInt(), {
    targetSystem: 7, targetComponent: 1, frame: 0, command: 43003, current: 0, autocontinue: 0, _param1: 146.25,
    _param2: 0, _param3: NaN, _param4: 0, _param5: 377632123, _param6: -1222571987, _param7: NaN,
  }],
  global_position_sensor: [new GlobalPositionSensor(), {
    timeUsec: 1763724896500000n, processingTime: 250000, lat: 377632123, lon: -1222571987, altEllipsoid: NaN,
    alt: 512.25, eph: 2.5, epv: NaN, targetSystem: 7, targetComponent: 0, id: 3, source: 2, flags: 0,
  }],
  global_position_sensor_unknown: [new GlobalPositionSensor(), {
    timeUsec: 1763724896250000n, processingTime: 0, lat: 377632123, lon: -1222571987, altEllipsoid: NaN, alt: NaN,
    eph: NaN, epv: NaN, targetSystem: 7, targetComponent: 0, id: 3, source: 2, flags: 0,
  }],
};

const result = {};
for (const [name, [message, fields]] of Object.entries(messages)) {
  Object.assign(message, fields);
  result[name] = new MavLinkProtocolV2(7, 197).serialize(message, 41).toString("hex");
}
if (process.argv[2]) {
  assert.deepEqual(JSON.parse(readFileSync(process.argv[2], "utf8")), result);
} else {
  console.log(JSON.stringify(result, null, 2));
}
