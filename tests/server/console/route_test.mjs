// A planned route on the page: node route_test.mjs FOLDER/OF/THE/PAGE
import assert from 'node:assert/strict';
import { drawn, GREEN, load, node, run, service, view, YELLOW } from './page.mjs';

const { linesAbout, longestWithout, LOOKS, Route } = await load('route.js');
const output = node();
const route = new Route(view, output);
const [DARK_RED, GREY] = ['#d93025', '#9aa0a6'];
const EVERY_M = 200;

const properties = (kinds) => kinds.map((place, i) => ({ from_m: EVERY_M * i, to_m: EVERY_M * (i + 1), place, probability: 0.5 }));
const line = (i) => ({ type: 'LineString', coordinates: [[38 + 0.001 * i, 37], [38.001 + 0.001 * i, 37]] });
/// As the service: so many pieces from where it is asked to go on.
function serves(kinds, more = {}) {
  const asked = [];
  service.answers = {
    '/map/localizability': (url, { method, body }) => {
      const query = new URLSearchParams(url.split('?')[1]);
      const first = Number(query.get('from_m')) / EVERY_M;
      const end = Math.min(first + Number(query.get('limit')), kinds.length);
      asked.push({ method, bytes: body.byteLength, footprint: query.get('footprint_m'), first, end });
      const features = properties(kinds).slice(first, end).map((each, i) => ({ type: 'Feature', geometry: line(first + i), properties: each }));
      return { type: 'FeatureCollection', features, length_m: EVERY_M * kinds.length, complete: end === kinds.length, next_m: EVERY_M * end, left_out: [], ...more };
    },
  };
  return asked;
}
const file = { name: 'mission.plan', arrayBuffer: async () => new ArrayBuffer(7) };
const colours = () => [...drawn].filter(({ kind }) => kind === 'line').map(({ color }) => color);

await run({
  'the longest way without a fix is the longest in a row, of whatever kinds'() {
    assert.deepEqual(longestWithout(properties(['bare', 'distinct', 'sparse', 'unknown', 'distinct', 'sparse'])), [400, 800]);
    assert.deepEqual(longestWithout(properties(['distinct', 'bare'])), [200, 400]);
    assert.equal(longestWithout(properties(['distinct'])), null);
  },
  'what is told of a route names each kind that there is'() {
    const lines = linesAbout(properties(['distinct', 'distinct', 'bare', 'distinct']), 800, ['item 3, a StructureScan']).join('\n');
    assert.match(lines, /^0\.8 km$/m);
    assert.match(lines, /75 % distinct.*\n25 % bare/);
    assert.doesNotMatch(lines, /sparse|unknown/);
    assert.match(lines, /longest without a fix: 0\.2 km, from km 0\.4 to 0\.6/);
    assert.match(lines, /left out: item 3, a StructureScan/);
    assert.match(linesAbout(properties(['distinct']), 200, []).join('\n'), /a fix all along/);
  },
  async 'a route is asked for in parts until its end, and drawn by what its pieces are worth'() {
    const asked = serves(['distinct', ...Array(8).fill('sparse'), 'bare', 'unknown']);
    await route.ask('/map', file, { footprint_m: 400 });
    assert.deepEqual(asked, [
      { method: 'POST', bytes: 7, footprint: '400', first: 0, end: 8 }, { method: 'POST', bytes: 7, footprint: '400', first: 8, end: 11 }]);
    assert.deepEqual(colours(), [GREEN, ...Array(8).fill(YELLOW), DARK_RED, GREY]);
    assert.match(output.textContent, /mission\.plan\n2\.2 km/);
    assert.ok(output.revealed);
  },
  'ground without a fix is told from ground with one also by who sees no hues'() {
    /// Relative luminance (WCAG 2).
    const light = (colour) => [1, 3, 5].map((at) => (parseInt(colour.slice(at, at + 2), 16) / 255 + 0.055) / 1.055)
      .reduce((sum, value, i) => sum + [0.2126, 0.7152, 0.0722][i] * value ** 2.4, 0.05);
    assert.ok(light(LOOKS.distinct.color) > 2.5 * light(LOOKS.bare.color));
    assert.ok(light(LOOKS.bare.color) > 3 * light('#161b21'), 'nor is it lost on the ground of the map');
  },
  async 'the footprint of a camera is asked for by its field of view, and told with the heights that it follows'() {
    const heights = [{ agl_m: 120.4, footprint_m: 160 }, {}, { agl_m: 300, footprint_m: 400.4 }];
    let asked = '';
    service.answers = {
      '/map/localizability': (url) => {
        asked = url;
        const features = properties(['sparse', 'unknown', 'distinct']).map((each, i) => ({ type: 'Feature', geometry: line(i), properties: { ...each, ...heights[i] } }));
        return { type: 'FeatureCollection', features, length_m: 600, complete: true, left_out: [] };
      },
    };
    await route.ask('/map', file, { fov_deg: '73.5' });
    assert.match(asked, /fov_deg=73\.5/);
    assert.doesNotMatch(asked, /footprint_m/);
    assert.match(output.textContent, /120 to 300 m above ground, of which frames show 160 to 400 m/);
  },
  async 'a part of it that is found tells how far that is'() {
    serves(Array(10).fill('distinct'));
    const whole = service.answers['/map/localizability'];
    let release;
    service.answers['/map/localizability'] = async (url, options) => {
      if (!url.includes('from_m=0')) await new Promise((go) => { release = go; });
      return whole(url, options);
    };
    const asked = route.ask('/map', file, { footprint_m: 400 });
    await new Promise(setImmediate);
    assert.match(output.textContent, /looking …\nmission\.plan\n1\.6 of 2\.0 km are looked at/);
    release();
    await asked;
    assert.match(output.textContent, /route\nmission\.plan\n2\.0 km\n/);
  },
  async 'a route that lies elsewhere than the view is shown'() {
    serves(['distinct']);
    view.middle = 10;
    view.moved = null;
    await route.ask('/map', file, { footprint_m: 400 });
    assert.deepEqual(view.moved, [37, 38]);
    view.middle = 38;
  },
  async 'what the service says of a route that it cannot read is told'() {
    service.answers = { '/map/localizability': { status: 422, title: 'Unprocessable content', detail: 'a route needs at least two places' } };
    await route.ask('/map', file, { footprint_m: 400 });
    assert.match(output.textContent, /a route needs at least two places/);
    assert.deepEqual(colours(), []);
  },
  async 'a service that finds nothing in its time is not asked for ever'() {
    serves(['distinct'], { features: [], complete: false, next_m: 0 });
    await route.ask('/map', file, { footprint_m: 400 });
    assert.match(output.textContent, /too busy/);
  },
  async 'a route that is forgotten leaves the page, and so does what comes of it later'() {
    serves(['distinct']);
    const asked = route.ask('/map', file, { footprint_m: 400 });
    route.forget();
    await asked;
    assert.equal(output.textContent, '');
    assert.deepEqual(colours(), []);
  },
});
