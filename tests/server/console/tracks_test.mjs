// What the page shows of a track while its service comes and goes: node tracks_test.mjs FOLDER/OF/THE/PAGE
import assert from 'node:assert/strict';
import { copyFileSync, mkdtempSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';

// A copy inside a package, since node takes a .js file outside of one for no module.
const folder = mkdtempSync(join(tmpdir(), 'roadfix-console-'));
writeFileSync(join(folder, 'package.json'), '{"type":"module"}');
for (const name of ['tracks.js', 'show.js', 'geometry.js']) copyFileSync(join(process.argv[2], name), join(folder, name));
process.on('exit', () => rmSync(folder, { recursive: true }));

let drawn = [];
const figure = (kind) => (at, style = {}) => {
  const made = {
    addTo() { drawn.push({ kind, at, ...style }); return made; }, bindTooltip: () => made, setLatLngs() {}, addLatLng() {},
  };
  return made;
};
const group = { addTo: () => group, clearLayers() { drawn = []; } };
globalThis.L = { polyline: figure('line'), polygon: figure('ellipse'), circleMarker: figure('point'), layerGroup: () => group };

function node() {
  const classes = new Set();
  return {
    text: '', options: [], value: '',
    classList: {
      add: (name) => classes.add(name), contains: (name) => classes.has(name), remove: (...names) => names.forEach((name) => classes.delete(name)),
      toggle: (name, on) => (on ? classes.add(name) : classes.delete(name)),
    },
    replaceChildren() {}, append() {}, prepend() {}, addEventListener() {}, insertRow: node, insertCell: node,
    add(option) { this.options.push(option); },
  };
}
globalThis.document = { createElement: node };
globalThis.Option = class { constructor(text, value) { Object.assign(this, { text, value }); } };

let stream;
globalThis.EventSource = class extends EventTarget {
  constructor() { super(); stream = this; }
  close() {}
  send(step) { this.dispatchEvent(Object.assign(new Event('step'), { data: JSON.stringify(step) })); }
};
let service = { tracks: [{ id: 'one', map: { name: 'city' }, stale: false }, { id: 'two', map: { name: 'city' }, stale: false }] };
globalThis.fetch = async () => {
  if (!service) throw new TypeError('fetch failed');
  return { ok: true, json: async () => service };
};
globalThis.setInterval = () => {};

const { Tracks } = await import(join(folder, 'tracks.js'));
const { LastQuestion } = await import(join(folder, 'show.js'));

const cluster = (lat, weight) => ({ pose: { lat, lon: 38, heading_deg: 0 }, sigma_m: [3, 2], ellipse_heading_deg: 0, weight });
const converged = {
  sequence: 1, status: 'converged', pose: { lat: 37, lon: 38, heading_deg: 0 }, radius95_m: 6, clusters: [cluster(37, 0.9), cluster(37.1, 0.1)],
  cluster_count: 2, measurement: 'accepted', since_accepted_s: 0, resets: 0, drifts: false,
};
const colours = () => drawn.filter(({ kind }) => kind === 'ellipse').map(({ color }) => color);
const [green, yellow, red] = ['#7ee0a1', '#f4c95d', '#f28b82'];

let middle = 38;
const list = node();
const output = node();
const view = { getCenter: () => ({ lat: 37, lng: middle }) };
const tracks = new Tracks(view, list, output);
const cases = {
  'only the place that a track is sure of is drawn as one'() {
    tracks.follow('one');
    stream.send(converged);
    assert.deepEqual(colours(), [green, yellow]);
  },
  'a lost connection makes the last estimate an old one, until there is a connection again'() {
    stream.dispatchEvent(new Event('error'));
    assert.ok(output.classList.contains('cut-off'));
    assert.deepEqual(colours(), [red, red]);
    stream.dispatchEvent(new Event('open'));
    assert.ok(!output.classList.contains('cut-off'));
    assert.deepEqual(colours(), [green, yellow]);
  },
  'an ended track is an old one for good'() {
    tracks.follow('one');
    stream.send(converged);
    stream.dispatchEvent(new Event('end'));
    assert.ok(output.classList.contains('ended'));
    assert.deepEqual(colours(), [red, red]);
  },
  'another track begins without what was lost of the one before'() {
    stream.dispatchEvent(new Event('error'));
    tracks.follow('two');
    assert.ok(!output.classList.contains('ended'));
    assert.ok(!output.classList.contains('cut-off'));
    assert.deepEqual(colours(), []);
  },
  'a place beyond the 180th meridian is drawn on the side that is shown'() {
    tracks.follow('one');
    middle = 180.01;
    const [east, west] = [cluster(37, 0.9), cluster(37, 0.1)];
    east.pose.lon = -179.98;
    west.pose.lon = 179.99;
    stream.send({ ...converged, clusters: [east, west] });
    const longitudes = drawn.filter(({ kind }) => kind === 'point').map(({ at }) => at[1]);
    assert.deepEqual(longitudes.map((lon) => lon.toFixed(2)), ['180.02', '179.99']);
  },
  async 'a service that does not answer takes no track off the list'() {
    await tracks.refresh();
    assert.deepEqual(list.options.map(({ value }) => value), ['one', 'two']);
    service = null;
    await tracks.refresh();
    assert.deepEqual(list.options.map(({ value }) => value), ['one', 'two']);
  },
  'a question ends those before it'() {
    const questions = new LastQuestion();
    const first = questions.next();
    const second = questions.next();
    assert.ok(first.aborted);
    assert.ok(!second.aborted);
  },
};

for (const [name, check] of Object.entries(cases)) {
  await check();
  console.log(`ok: ${name}`);
}
