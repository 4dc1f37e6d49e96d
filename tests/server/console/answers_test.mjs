// What the page shows of its answers when the question is another one by then: node answers_test.mjs FOLDER/OF/THE/PAGE
import assert from 'node:assert/strict';
import { colours, drawn, GREEN, load, node, RED, run, service, uploads, view } from './page.mjs';

const { Answer } = await load('answer.js');
const { Places } = await load('places.js');
const { LastQuestion } = await load('show.js');

const mode = { pose: { lat: 37, lon: 38, heading_deg: 0 }, sigma_m: [3, 2], ellipse_heading_deg: 0, weight: 1 };
const fix = {
  status: 'fix', probability: 0.999, pose: mode.pose, heading_sigma_deg: 1, sigma_m: [3, 2], modes: [mode],
  searched: { area_km2: 1, headings: 120 }, time_ms: { detect: 1, search: 1 }, map: { name: 'city', version: '1' },
};
const picture = (name) => ({ name, type: 'image/png', arrayBuffer: async () => new ArrayBuffer(1) });
const output = node();
const answer = new Answer(view, output);
const isOld = () => output.classList.contains('old');
async function ask(name = 'a.png') {
  service.answers = { '/fix': fix };
  await answer.ask('/fix?kind=frame', picture(name));
}

const place = node();
const footprint = { value: '400' };
const wanted = { checked: true };
const places = new Places(view, place, footprint, wanted);
const latlng = { lat: 37, lng: 38, wrap: () => latlng };

await run({
  async 'a fix names the picture that it is of'() {
    await ask('frame_07.png');
    assert.match(output.textContent, /frame_07\.png/);
    assert.deepEqual(colours(), [GREEN]);
    assert.ok(!isOld());
    assert.deepEqual(view.moved, [37, 38]);
  },
  async 'what is no fix gives hints, drawn faint, and no place to read off'() {
    service.answers = { '/fix': { ...fix, status: 'no_fix', pose: null, reason: 'too little road', modes: [mode, { ...mode, weight: 0.5 }] } };
    view.moved = null;
    await answer.ask('/fix', picture('a.png'));
    assert.match(output.textContent, /^no fix\ntoo little road/);
    assert.match(output.textContent, /hints\n2, not to be flown on/);
    assert.doesNotMatch(output.textContent, /lat, lon|37\.0/);
    assert.deepEqual(colours(), [RED, RED]);
    assert.equal(view.moved, null);
  },
  async 'a fix of a height above the sea says how high above ground that is'() {
    await ask();
    assert.doesNotMatch(output.textContent, /above ground/);
    service.answers = { '/fix': { ...fix, agl_m: 319.6 } };
    await answer.ask('/fix', picture('a.png'));
    assert.match(output.textContent, /above ground\n320 m/);
  },
  async 'a fix says the day and the zone of its time'() {
    await ask();
    const date = new Date();
    assert.ok(output.textContent.includes(date.toLocaleDateString([], { dateStyle: 'medium' })), output.textContent);
    const zone = new Intl.DateTimeFormat([], { timeZoneName: 'short' }).formatToParts(date).find(({ type }) => type === 'timeZoneName');
    assert.ok(output.textContent.includes(zone.value), output.textContent);
  },
  async 'an answer is brought into sight, and one that was given up for another question moves nothing'() {
    output.revealed = false;
    service.answers = { '/fix': () => new Promise(() => {}) };
    answer.ask('/fix', picture('a.png'));
    answer.questionChanged();
    await new Promise(setImmediate);
    assert.ok(!output.revealed);
    await ask();
    assert.ok(output.revealed);
  },
  async 'it is said how much of a picture is sent, and no more of it once the question is another one'() {
    let give;
    service.answers = { '/fix': () => new Promise((later) => { give = later; }) };
    const large = { name: 'a.png', type: 'image/png', arrayBuffer: async () => new ArrayBuffer(8_400_000) };
    const asked = answer.ask('/fix', large);
    await new Promise(setImmediate);
    assert.match(output.textContent, /^sending …\n0 of 8400 kB/);
    assert.equal(output.ariaBusy, null);
    uploads.last.upload.onprogress({ loaded: 2_100_000 });
    assert.match(output.textContent, /2100 of 8400 kB/);
    assert.equal(output.ariaBusy, 'true', 'no screen reader reads on and on');
    uploads.last.upload.onload();
    assert.match(output.textContent, /^searching/);
    assert.equal(output.ariaBusy, null);
    give(fix);
    await asked;
    assert.match(output.textContent, /^fix/);
    answer.ask('/fix', large);
    await new Promise(setImmediate);
    answer.questionChanged();
    answer.questionChanged();
    uploads.last.upload.onprogress({ loaded: 2_100_000 });
    assert.equal(output.textContent, '');
  },
  async 'a picture that is still read when the question is another one is neither sent nor said to be unreadable'() {
    for (const reading of [() => new ArrayBuffer(1), () => { throw new DOMException('gone', 'NotReadableError'); }]) {
      let read;
      const slow = { name: 'a.png', type: 'image/png', arrayBuffer: () => new Promise((later) => { read = later; }).then(reading) };
      const asked = answer.ask('/fix', slow);
      answer.questionChanged();
      read();
      await asked;
      assert.equal(output.textContent, '');
    }
  },
  async 'a service that cannot be reached while a picture is sent is said to be so'() {
    service.answers = {};
    await answer.ask('/fix', picture('a.png'));
    assert.match(output.textContent, /The service gives no answer/);
  },
  async 'a feature map takes no time to detect'() {
    service.answers = { '/fix': { ...fix, time_ms: { search: 7.4 } } };
    await answer.ask('/fix', picture('roads.png'));
    assert.match(output.textContent, /\b7 ms to search/);
    assert.doesNotMatch(output.textContent, /detect|NaN/);
  },
  async 'the error page of a proxy is told from an answer of the service'() {
    service.answers = { '/fix': '413' };
    await answer.ask('/fix', picture('a.png'));
    assert.match(output.textContent, /proxy before the service answered 413/);
    assert.match(output.textContent, /send a smaller one/);
  },
  async 'a fix is an old one as soon as the question is another one'() {
    await ask();
    answer.questionChanged();
    assert.ok(isOld());
    assert.match(output.textContent, /the question has changed/);
    assert.deepEqual(colours(), [RED]);
    await ask('b.png');
    assert.ok(!isOld());
    assert.deepEqual(colours(), [GREEN]);
  },
  async 'an answer that is awaited is given up when the question is another one'() {
    let late;
    service.answers = { '/fix': () => new Promise((give) => { late = give; }) };
    const asked = answer.ask('/fix', picture('a.png'));
    await new Promise(setImmediate);
    answer.questionChanged();
    late(fix);
    await asked;
    assert.equal(output.textContent, '');
    assert.deepEqual(colours(), []);
  },
  async 'a fix is an old one when its map was replaced or is no longer served'() {
    const others = [{ name: 'town', version: '2' }];
    for (const maps of [others, [...others, { name: 'city', version: '2' }], [{ name: 'city', status: 'unreadable' }]]) {
      await ask();
      answer.mapsChanged([...others, { name: 'city', version: '1' }]);
      assert.ok(!isOld());
      answer.mapsChanged(maps);
      assert.ok(isOld());
      assert.deepEqual(colours(), [RED]);
      const [said] = output.children;
      answer.mapsChanged(maps);
      assert.equal(output.children[0], said, 'it is not said again at each look at the maps');
    }
    answer.forget();
    answer.mapsChanged(others);
    assert.equal(output.textContent, '');
  },
  async 'a picture that was written anew since it was chosen is said to be unreadable, not the service'() {
    const gone = { name: 'a.png', type: 'image/png', arrayBuffer: async () => { throw new DOMException('gone', 'NotReadableError'); } };
    await answer.ask('/fix', gone);
    assert.match(output.textContent, /choose it again/);
    assert.doesNotMatch(output.textContent, /gives no answer/);
  },
  'a question ends those before it'() {
    const questions = new LastQuestion();
    const first = questions.next();
    const second = questions.next();
    assert.ok(first.aborted);
    assert.ok(!second.aborted);
  },
  async 'a layer that cannot be drawn is said to be so, and holds up nothing else'() {
    service.answers = { '/map/localizability/tilejson.json': { status: 400, title: 'Bad request', detail: 'footprint_m is 1' } };
    await places.drawLayer('/map', 'v1', 18);
    assert.match(place.textContent, /footprint_m is 1/);
  },
  async 'tiles of a map that was replaced have other addresses, for what a browser keeps'() {
    const layer = () => [...drawn].find(({ kind }) => kind === 'tiles').at;
    service.answers = { '/map/localizability/tilejson.json': (url, { cache }) => cache === 'no-cache' && { bounds: [38, 37, 39, 38], minzoom: 10 } };
    await places.drawLayer('/map', 'v1', 18);
    const before = layer();
    await places.drawLayer('/map', 'v2', 18);
    assert.notEqual(layer(), before);
  },
  async 'a layer across the 180th meridian is drawn on both sides of it'() {
    const layer = () => [...drawn].find(({ kind }) => kind === 'tiles').bounds;
    service.answers = { '/map/localizability/tilejson.json': { bounds: [-180, -17, 180, -16], minzoom: 10 } };
    await places.drawLayer('/map', 'v1', 18);
    assert.equal(layer(), null);
    service.answers = { '/map/localizability/tilejson.json': { bounds: [38, 37, 39, 38], minzoom: 10 } };
    await places.drawLayer('/map', 'v1', 18);
    assert.deepEqual(layer(), [[37, 38], [38, 39]]);
  },
  async 'a layer that was asked for comes no more once its map has left'() {
    const tiles = () => [...drawn].filter(({ kind }) => kind === 'tiles').length;
    let late;
    const tileset = { bounds: [38, 37, 39, 38], minzoom: 10, maxzoom: 16 };
    service.answers = { '/map/localizability/tilejson.json': tileset };
    await places.drawLayer('/map', 'v1', 18);
    assert.equal(tiles(), 1);
    service.answers = { '/map/localizability/tilejson.json': () => new Promise((give) => { late = give; }) };
    const asked = places.drawLayer('/map', 'v1', 18);
    await new Promise(setImmediate);
    places.removeLayer();
    late(tileset);
    await asked;
    assert.equal(tiles(), 0);
  },
  async 'what is known of a place is forgotten with its footprint'() {
    service.answers = { '/map/localizability': { status: 'fix', reason: '', probability: 1, road_share: 0.1, observed_share: 1 } };
    await places.ask('/map', latlng);
    assert.match(place.textContent, /^fix/);
    assert.ok(drawn.size);
    places.forget();
    assert.equal(place.textContent, '');
    assert.deepEqual(colours(), []);
  },
});
