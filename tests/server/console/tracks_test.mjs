// What the page shows of a track while its service comes and goes: node tracks_test.mjs FOLDER/OF/THE/PAGE
import assert from 'node:assert/strict';
import { colours, drawn, GREEN, load, node, RED, run, service, view, YELLOW } from './page.mjs';

const { Tracks } = await load('tracks.js');
let now = 1_000_000;
Date.now = () => now;
/// Of the last question.
let endPatience;
let patienceMs;
AbortSignal.timeout = (ms) => {
  const patience = new AbortController();
  patienceMs = ms;
  endPatience = () => patience.abort(new DOMException('', 'TimeoutError'));
  return patience.signal;
};

const cluster = (lat, weight) => ({ pose: { lat, lon: 38, heading_deg: 0 }, sigma_m: [3, 2], ellipse_heading_deg: 0, weight });
const converged = {
  sequence: 1, status: 'converged', pose: { lat: 37, lon: 38, heading_deg: 0 }, heading_sigma_deg: 1, radius95_m: 6,
  clusters: [cluster(37, 0.9), cluster(37.1, 0.1)], cluster_count: 2, measurement: 'accepted', since_accepted_s: 0, resets: 0, drifts: false,
};
const track = (id, last, silent_s = 0.1) => ({ id, map: { name: 'city', version: '1' }, created_us: 0, silent_s, last_age_s: silent_s, stale: silent_s >= 60, last });
const ended = { status: 410, title: 'Gone', code: 'track-ended' };
const place = (sequence, lat, lon = 38) => ({ geometry: lat && { type: 'Point', coordinates: [lon, lat] }, properties: { sequence } });
const answer = (one, history = []) => { service.answers = { '/v1/tracks/one': one, '/v1/tracks/one/history': { features: history } }; };

const list = node();
const output = node();
const details = node();
const maps = { on: { name: 'city', version: '1' }, wishes: [], shown: () => maps.on, wish: (name) => maps.wishes.push(name) };
const tracks = new Tracks(view, list, output, details, maps);
const isOld = () => {
  assert.equal(output.classList.contains('old'), details.classList.contains('old'));
  return output.classList.contains('old');
};

await run({
  async 'only the place that a track is sure of is drawn as one'() {
    answer(track('one', converged));
    await tracks.follow('one');
    assert.deepEqual(colours(), [GREEN, YELLOW]);
    assert.match(details.textContent, /37\.000000, 38\.000000/);
    assert.ok(!isOld());
  },
  async 'a track that claims no place says why'() {
    const { pose, ...searching } = { ...converged, sequence: 2, status: 'searching', explanation: 'fly on over ground with roads' };
    answer(track('one', searching));
    await tracks.look();
    assert.match(output.textContent, /searching/);
    assert.match(details.textContent, /no place\nfly on over ground with roads/);
    assert.doesNotMatch(details.textContent, /lat, lon|within/);
    answer(track('one', converged));
    await tracks.look();
    assert.match(details.textContent, /37\.000000, 38\.000000/);
  },
  async 'a service that cannot be reached makes the last estimate an old one, until it answers again'() {
    service.answers = null;
    await tracks.look();
    assert.ok(isOld());
    assert.match(output.textContent, /gives no answer/);
    assert.deepEqual(colours(), [RED, RED]);
    answer({ status: 502 });
    await tracks.look();
    assert.ok(isOld());
    answer(track('one', converged));
    await tracks.look();
    assert.ok(!isOld());
    assert.deepEqual(colours(), [GREEN, YELLOW]);
  },
  async 'the error page of a proxy ends no track'() {
    service.answers = { '/v1/tracks/one': '404' };
    await tracks.look();
    assert.match(output.textContent, /proxy before the service answered 404/);
    assert.ok(isOld());
    answer(track('one', converged));
    await tracks.look();
    assert.ok(!isOld());
  },
  async 'a connection that hangs is given up in time, and the track asked for anew'() {
    service.answers = { '/v1/tracks/one': (url, { signal }) => new Promise((give, fail) => { signal.addEventListener('abort', () => fail(signal.reason)); }) };
    const asked = tracks.look();
    endPatience();
    await asked;
    assert.match(output.textContent, /gives no answer/);
    answer(track('one', converged));
    await tracks.look();
    assert.ok(!isOld());
  },
  async 'a picture that came over a slow link makes an old estimate'() {
    answer({ ...track('one', converged), last_age_s: 14 });
    await tracks.look();
    assert.match(details.textContent, /14 s ago/);
    assert.match(output.textContent, /the last step is older than 10 s/);
    assert.ok(isOld());
    answer(track('one', converged));
    await tracks.look();
    assert.ok(!isOld());
  },
  async 'a place from before the service was started anew is an old one, since nobody knows its age'() {
    const { last_age_s, ...restarted } = track('one', converged, 2);
    answer(restarted);
    await tracks.look();
    assert.ok(isOld());
    assert.match(output.textContent, /the service was started anew/);
    assert.deepEqual(colours(), [RED, RED]);
    answer(track('one', { ...converged, sequence: 2 }));
    await tracks.look();
    assert.ok(!isOld());
    assert.deepEqual(colours(), [GREEN, YELLOW]);
  },
  async 'an estimate grows old also while an answer is awaited'() {
    service.answers = { '/v1/tracks/one': () => new Promise(() => {}) };
    tracks.look();
    now += 9000;
    await tracks.look();
    assert.match(details.textContent, /9 s ago/);
    assert.ok(!isOld());
    now += 1000;
    await tracks.look();
    assert.ok(isOld());
    assert.deepEqual(colours(), [RED, RED]);
  },
  async 'a vehicle that is silent is where it was, and is said to have been'() {
    answer(track('one', converged, 30));
    await tracks.follow('one');
    assert.match(details.textContent, /30 s ago/);
    assert.match(output.textContent, /the last step is older than 10 s/);
    assert.deepEqual(colours(), [RED, RED]);
    answer(track('one', { ...converged, sequence: 2 }));
    await tracks.look();
    assert.match(details.textContent, /0 s ago/);
    assert.deepEqual(colours(), [GREEN, YELLOW]);
  },
  async 'an ended track is an old one for good, also one that the service knows of no more'() {
    for (const end of [ended, { status: 404, title: 'Not Found', code: 'track-not-found' }]) {
      answer(track('one', converged));
      await tracks.follow('one');
      answer(end);
      await tracks.look();
      assert.match(output.textContent, /the track has ended/);
      answer(track('one', converged));
      await tracks.look();
      assert.ok(isOld());
      assert.deepEqual(colours(), [RED, RED]);
    }
  },
  async 'another track begins without what was lost of the one before, nor its late answer'() {
    let late;
    service.answers = { '/v1/tracks/one': () => new Promise((give) => { late = give; }), '/v1/tracks/two': track('two') };
    const one = tracks.follow('one');
    await tracks.follow('two');
    assert.match(output.textContent, /no step has come yet/);
    late(track('one', converged));
    await one;
    assert.match(output.textContent, /no step has come yet/);
    assert.ok(!isOld());
    assert.deepEqual(colours(), []);
  },
  async 'the line has gaps where the track was not sure, and grows from where it ends'() {
    answer(track('one', { ...converged, sequence: 3 }), [place(0, 36.9), place(1), place(2), place(3, 37)]);
    await tracks.follow('one');
    assert.deepEqual(tracks.path.at, [[[36.9, 38]], [[37, 38]]]);
    let asked;
    answer(track('one', { ...converged, sequence: 4 }));
    service.answers['/v1/tracks/one/history'] = (url) => { asked = url; return { features: [place(4, 37.1)] }; };
    await tracks.look();
    assert.match(asked, /after=3&/);
    assert.deepEqual(tracks.path.at, [[[36.9, 38]], [[37, 38], [37.1, 38]]]);
  },
  async 'a line that comes over a slow link is waited for, and holds up no estimate'() {
    let come;
    answer(track('one', converged));
    service.answers['/v1/tracks/one/history'] = () => new Promise((give) => { come = give; });
    const followed = tracks.follow('one');
    await new Promise(setImmediate);
    assert.ok(patienceMs >= 30_000);
    service.answers['/v1/tracks/one'] = track('one', { ...converged, sequence: 2, resets: 7 });
    await tracks.look();
    assert.match(details.textContent, /resets\n7/);
    come({ features: [place(0, 36.9)] });
    await followed;
    assert.deepEqual(tracks.path.at, [[[36.9, 38]]]);
  },
  async 'a track that is out of view is brought there once'() {
    answer(track('one', { ...converged, clusters: [cluster(50, 1)] }));
    view.moved = null;
    await tracks.follow('one');
    assert.deepEqual(view.moved, [50, 38]);
    view.moved = null;
    answer(track('one', { ...converged, sequence: 5, clusters: [cluster(51, 1)] }));
    await tracks.look();
    assert.equal(view.moved, null);
  },
  async 'a track that the list does not have gets a line while it is followed'() {
    const lines = () => list.options.map(({ value, text }) => [value, text.split(',')[0]]);
    service.answers = { '/v1/tracks': { tracks: [] } };
    await tracks.refresh();
    assert.deepEqual(lines(), []);
    service.answers['/v1/tracks/0123456789abcdef'] = null;
    await tracks.follow('0123456789abcdef');
    assert.deepEqual(lines(), [['0123456789abcdef', '01234567']]);
    assert.equal(list.value, '0123456789abcdef');
    list.options[0].selected = true;
    service.answers['/v1/tracks/0123456789abcdef'] = track('0123456789abcdef');
    await tracks.look();
    await tracks.refresh();
    assert.deepEqual(lines(), [['0123456789abcdef', 'city']]);
    list.options[0].selected = false;
    await tracks.follow('');
    await tracks.refresh();
    assert.deepEqual(lines(), []);
  },
  async 'the map of a track is wished for once, as it is chosen'() {
    answer(track('one', converged));
    maps.wishes = [];
    await tracks.follow('one');
    await tracks.look();
    assert.deepEqual(maps.wishes, ['city']);
  },
  async 'a track on another map than its own, or on what has taken its place, is said to be so'() {
    answer(track('one', converged));
    await tracks.follow('one');
    assert.doesNotMatch(output.textContent, /map/);
    maps.on = { name: 'town', version: '1' };
    await tracks.look();
    assert.match(output.textContent, /drawn on another map: it flies over city/);
    maps.on = { name: 'city', version: '2' };
    await tracks.look();
    assert.match(output.textContent, /its map was replaced/);
    maps.on = { name: 'city', version: '1' };
    await tracks.look();
    assert.doesNotMatch(output.textContent, /map/);
    answer(track('two'));
    service.answers['/v1/tracks/two'] = track('two');
    maps.on = { name: 'town', version: '1' };
    await tracks.follow('two');
    assert.match(output.textContent, /no step has come yet\ndrawn on another map/);
    maps.on = { name: 'city', version: '1' };
  },
  async 'a place beyond the 180th meridian is drawn on the side that is shown'() {
    view.middle = 180.01;
    const [east, west] = [cluster(37, 0.9), cluster(37, 0.1)];
    east.pose.lon = -179.98;
    west.pose.lon = 179.99;
    answer(track('one', { ...converged, clusters: [east, west] }));
    await tracks.follow('one');
    const longitudes = [...drawn].filter(({ kind }) => kind === 'point').map(({ at }) => at[1]);
    assert.deepEqual(longitudes.map((lon) => lon.toFixed(2)), ['180.02', '179.99']);
  },
  async 'places and the line go to the side of the 180th meridian that is shown, also when another view is chosen'() {
    const longitudes = () => [...drawn].filter(({ kind }) => kind === 'point').map(({ at }) => at[1].toFixed(2));
    const line = () => tracks.path.at.map((part) => part.map(([, lon]) => lon.toFixed(2)));
    view.middle = 0;
    const east = cluster(37, 1);
    east.pose.lon = -179.98;
    answer(track('one', { ...converged, sequence: 3, clusters: [east] }), [place(0, 37, 179.99), place(1, 37, -179.99), place(2), place(3, 37, -179.98)]);
    await tracks.follow('one');
    assert.deepEqual(longitudes(), ['-179.98']);
    assert.deepEqual(line(), [['-180.01', '-179.99'], ['-179.98']]);
    view.middle = 180.01;
    await tracks.look();
    assert.deepEqual(longitudes(), ['180.02']);
    assert.deepEqual(line(), [['179.99', '180.01'], ['180.02']]);
    view.middle = 38;
  },
  async 'what stays as it is is not said again and again'() {
    for (const body of [track('one'), ended]) {
      answer(body);
      await tracks.follow('one');
      const [said] = output.children;
      assert.ok(said);
      await tracks.look();
      assert.equal(output.children[0], said);
    }
    answer(track('one'));
    await tracks.follow('one');
    service.answers = null;
    await tracks.look();
    assert.match(output.textContent, /gives no answer/);
  },
  async 'a track that began on another day says on which'() {
    const at = (time) => ({ ...track('one'), created_us: new Date(time).getTime() * 1000 });
    const told = async (time) => {
      service.answers = { '/v1/tracks': { tracks: [at(time)] } };
      await tracks.refresh();
      return list.options[0].text;
    };
    const before = now;
    now = new Date('2026-03-07T18:00').getTime();
    const month = new Date(now).toLocaleDateString([], { month: 'short' });
    assert.ok(!(await told('2026-03-07T09:00')).includes(month));
    assert.ok((await told('2026-03-06T23:00')).includes(month));
    now = before;
  },
  async 'a service that does not answer takes no track off the list'() {
    const ids = () => list.options.map(({ value }) => value);
    service.answers = { '/v1/tracks': { tracks: [track('one'), track('two', converged, 80)] } };
    await tracks.refresh();
    assert.deepEqual(ids(), ['one', 'two']);
    assert.match(list.options[1].text, /, silent$/);
    service.answers = null;
    await tracks.refresh();
    assert.deepEqual(ids(), ['one', 'two']);
    service.answers = { '/v1/tracks': { tracks: [track('two')] } };
    await tracks.refresh();
    assert.deepEqual(ids(), ['two']);
    assert.doesNotMatch(list.options[0].text, /silent/);
  },
});
