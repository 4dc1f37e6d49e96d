// The page as a whole, from its first list of maps on: node main_test.mjs FOLDER/OF/THE/PAGE
import assert from 'node:assert/strict';
import { drawn, load, node, run, service, view } from './page.mjs';

const parts = {};
const by = (id) => (parts[id] ??= node());
const button = {};
const [agl, alt] = ['of-camera', 'of-camera of-heights'].map((className) => ({ parentElement: { className } }));
const fields = { what: { value: 'gsd' }, prior: { value: 'map' }, radius_m: { value: '1000' }, picture: node() };
Object.assign(by('ask'), { elements: fields, querySelector: () => button, querySelectorAll: () => [agl, alt] });
const onPage = {};
Object.assign(document, { getElementById: by, hidden: false, addEventListener(name, act) { onPage[name] = act; } });
globalThis.Event = class {};
globalThis.DataTransfer = class { files = []; items = { add: (file) => this.files.push(file) }; };

const circle = { remove() {} };
const tileLayer = L.tileLayer;
Object.assign(L, {
  map: () => ({ setView: () => view }), control: { scale: () => ({ addTo() {} }) }, circle: () => circle,
  tileLayer: (url, options) => Object.assign(tileLayer(url, options), { options }),
});
Object.assign(view, { on() {}, attributionControl: { setPrefix() {} }, fitBounds(box) { view.box = box; } });

const acts = {};
globalThis.window = { addEventListener(name, act) { acts[name] = act; } };
globalThis.location = { hash: '#map=town' };
globalThis.history = { replaceState(state, title, hash) { location.hash = hash; } };
let endPatience;
globalThis.setTimeout = (act) => { endPatience = act; };

const settled = () => new Promise(setImmediate);
const description = (name, version = '1') => ({ name, version, bbox: [38, 37, 39, 38], area_km2: 12, cell_m: 2, epsg: 32637, sources: [] });
const listed = (name, version = '1') => ({ name, version, status: 'ready', bbox: [38, 37, 39, 38] });
service.answers = {
  '/v1/maps': { maps: [listed('city'), listed('town')] },
  '/v1/maps/city': description('city'), '/v1/maps/city/tilejson.json': { maxzoom: 16, attribution: '' },
  '/v1/maps/town': description('town'), '/v1/maps/town/tilejson.json': { maxzoom: 16, attribution: '' },
};
const tiles = () => [...drawn].filter(({ kind }) => kind === 'tiles').map(({ at }) => at);
const hangs = (url, { signal }) => new Promise((give, fail) => { signal.addEventListener('abort', () => fail(signal.reason)); });

await load('main.js');
await settled();

await run({
  'the page opens the map of its address'() {
    assert.deepEqual(tiles(), ['/v1/maps/town/tiles/{z}/{x}/{y}.png?version=1']);
    assert.match(by('about').textContent, /12\.0 km² in cells of 2 m, EPSG:32637/);
    assert.deepEqual(view.box, [[37, 38], [38, 39]]);
    assert.equal(button.disabled, false);
  },
  async 'another map that is chosen takes its place, and the address names it'() {
    by('maps').value = 'city';
    by('maps').listeners.change();
    assert.deepEqual(tiles(), [], 'the roads of the map before leave at once');
    await settled();
    assert.deepEqual(tiles(), ['/v1/maps/city/tiles/{z}/{x}/{y}.png?version=1']);
    assert.equal(location.hash, '#map=city');
  },
  async 'a map whose description hangs is given up in time, and opened by a later look at the list'() {
    service.answers['/v1/maps/town'] = hangs;
    by('maps').value = 'town';
    by('maps').listeners.change();
    await settled();
    assert.match(by('about').textContent, /^opening/);
    endPatience();
    await settled();
    assert.match(by('about').textContent, /gives no answer\nno answer came in time/);
    service.answers['/v1/maps/town'] = description('town');
    await acts.focus();
    assert.deepEqual(tiles(), ['/v1/maps/town/tiles/{z}/{x}/{y}.png?version=1']);
  },
  async 'a map that was written anew is drawn anew where it is'() {
    view.box = null;
    service.answers['/v1/maps'] = { maps: [listed('town', '2')] };
    service.answers['/v1/maps/town'] = description('town', '2');
    await acts.focus();
    assert.deepEqual(tiles(), ['/v1/maps/town/tiles/{z}/{x}/{y}.png?version=2']);
    assert.equal(view.box, null);
  },
  async 'what the map knows of the heights of its ground is told, and told anew when that changes'() {
    assert.match(by('about').textContent, /heights of the ground not known/);
    const terrain = { lowest_m: 500, highest_m: 518, known_share: 1 };
    service.answers['/v1/maps'] = { maps: [{ ...listed('town', '2'), terrain }] };
    service.answers['/v1/maps/town'] = { ...description('town', '2'), terrain };
    await acts.focus();
    assert.match(by('about').textContent, /ground 500 to 518 m above the sea/);
    service.answers['/v1/maps'] = { maps: [listed('town', '2')] };
    service.answers['/v1/maps/town'] = description('town', '2');
    await acts.focus();
    assert.match(by('about').textContent, /heights of the ground not known/);
  },
  async 'a height above the sea is asked for of a camera over a map that knows the heights of its ground'() {
    const asksFor = () => [agl, alt].map(({ disabled }) => !disabled);
    const choose = async (name) => {
      by('maps').value = name;
      by('maps').listeners.change();
      await settled();
    };
    service.answers['/v1/maps'] = { maps: [{ ...listed('city'), terrain: { lowest_m: 500, highest_m: 518 } }, listed('town', '2')] };
    await acts.focus();
    assert.deepEqual(asksFor(), [false, false]);
    fields.what.value = 'camera';
    by('ask').listeners.input();
    assert.deepEqual(asksFor(), [true, false]);
    await choose('city');
    assert.deepEqual(asksFor(), [true, true]);
    service.answers['/v1/maps'] = { maps: [listed('city'), listed('town', '2')] };
    await acts.focus();
    assert.deepEqual(asksFor(), [true, false], 'the heights were taken out of the map');
  },
  async 'what is dropped on the page is a picture or a route by its name'() {
    const given = [];
    for (const [input, what] of [[fields.picture, 'picture'], [by('route'), 'route']]) input.dispatchEvent = () => given.push(`${what} ${input.files[0].name}`);
    const drop = (name) => onPage.drop({ type: 'drop', preventDefault() {}, dataTransfer: { files: [{ name }] } });
    for (const name of ['frame.JPG', 'mission.plan', 'lawn.WAYPOINTS', 'plan.png']) drop(name);
    assert.deepEqual(given, ['picture frame.JPG', 'route mission.plan', 'route lawn.WAYPOINTS', 'picture plan.png']);
  },
  async 'a route is asked for on the map that is shown, and forgotten with it'() {
    const asked = [];
    service.answers['/v1/maps/city/localizability'] = (url) => { asked.push(url); return { status: 422, title: 'no', detail: 'two places at least' }; };
    Object.assign(by('route'), { value: 'mission.plan', files: [{ name: 'mission.plan', arrayBuffer: async () => new ArrayBuffer(1) }] });
    by('footprint').value = '300';
    by('route').listeners.input();
    await settled();
    await settled();
    assert.match(asked[0], /footprint_m=300/);
    by('fov').value = '73';
    by('fov').listeners.change();
    await settled();
    await settled();
    assert.match(asked[1], /fov_deg=73/);
    assert.doesNotMatch(asked[1], /footprint_m/);
    assert.match(by('along').textContent, /two places at least/);
    by('route').listeners.cancel();
    await settled();
    await settled();
    assert.equal(asked.length, 3, 'it was changed, and chosen again');
    by('maps').value = 'town';
    by('maps').listeners.change();
    assert.equal(by('along').textContent, '');
    assert.equal(by('route').value, '');
  },
  async 'a service that does not answer is said to be away, until it answers again'() {
    const answers = service.answers;
    service.answers = null;
    await acts.focus();
    assert.match(by('trouble').textContent, /gives no answer/);
    const said = by('trouble').textContent;
    Object.defineProperty(by('trouble'), 'textContent', { configurable: true, get: () => said, set() { assert.fail('said again at the next look'); } });
    await acts.focus();
    delete by('trouble').textContent;
    service.answers = answers;
    await acts.focus();
    assert.equal(by('trouble').textContent, '');
  },
  'an address that names a map alone follows no track, as where the page is loaded with it'() {
    for (const [hash, track] of [['#track=one', 'one'], ['#map=town', '']]) {
      location.hash = hash;
      acts.hashchange();
      assert.equal(by('tracks').value, track);
    }
  },
});
