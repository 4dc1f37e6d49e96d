// How the page brings tiles, and what it does about those that do not come: node tiles_test.mjs FOLDER/OF/THE/PAGE
import assert from 'node:assert/strict';
import { load, run } from './page.mjs';

const { tilesOf } = await load('tiles.js');

const pauses = [];
let atPause = () => {};
globalThis.setTimeout = (go, pause) => {
  pauses.push(pause);
  atPause(pauses.length);
  setImmediate(go);
};
const settled = async () => { for (let i = 0; i < 100; i += 1) await new Promise(setImmediate); };

/// What the service answers; null: it is away.
let status;
let asked;
globalThis.fetch = async () => {
  asked += 1;
  if (!status) throw new TypeError('fetch failed');
  return { status };
};

/// Of the tiles on the page; `loads` counts how often their picture was asked for. Pictures come at once, unless they are
/// to be slow: then by arrive().
let slow;
document.createElement = () => {
  const heard = {};
  const tile = {
    isConnected: true, loads: 0, ready: false, hidden: null, addEventListener: (name, act) => { heard[name] = act; },
    arrive: () => heard[status === 200 ? 'load' : 'error'](),
    set src(url) {
      assert.equal(url, '/tiles/1/2/3.png');
      tile.loads += 1;
      if (!slow) queueMicrotask(tile.arrive);
    },
  };
  return tile;
};
function tilesOfPage(count, atATime = 3) {
  const layer = tilesOf('/tiles/{z}/{x}/{y}.png', {}, atATime);
  layer.getTileUrl = () => '/tiles/1/2/3.png';
  const done = (hidden, tile) => Object.assign(tile, { ready: true, hidden });
  return Array.from({ length: count }, () => layer.createTile({}, done));
}
function begin() {
  pauses.length = 0;
  atPause = () => {};
  slow = false;
  asked = 0;
}

await run({
  async 'a tile that comes is shown'() {
    begin();
    status = 200;
    const [tile] = tilesOfPage(1);
    await settled();
    assert.deepEqual([tile.ready, tile.hidden, tile.loads, asked], [true, false, 1, 0]);
  },
  async 'a tile that shows nothing is asked about once, and hidden'() {
    begin();
    status = 204;
    const [tile] = tilesOfPage(1);
    await settled();
    assert.deepEqual([tile.ready, tile.hidden, tile.loads, asked], [true, true, 1, 1]);
    assert.deepEqual(pauses, []);
  },
  async 'a tile is loaded as soon as the service answers again, after growing pauses'() {
    begin();
    status = null;
    atPause = (count) => {
      if (count === 3) status = 503;
      if (count === 6) status = 200;
    };
    const [tile] = tilesOfPage(1);
    await settled();
    assert.ok(tile.ready);
    assert.deepEqual(pauses, [1000, 2000, 4000, 8000, 10_000, 10_000]);
  },
  async 'a tile that has left the page is asked for no more'() {
    begin();
    status = null;
    let tile;
    atPause = (count) => { tile.isConnected = count < 2; };
    [tile] = tilesOfPage(1);
    await settled();
    assert.deepEqual([tile.ready, tile.loads], [false, 2]);
  },
  async 'slow tiles leave connections to what is asked of tracks, and those that have left the page take no turn'() {
    begin();
    slow = true;
    status = 200;
    const tiles = tilesOfPage(6, 2);
    const loads = () => tiles.map((tile) => tile.loads);
    await settled();
    assert.deepEqual(loads(), [1, 1, 0, 0, 0, 0]);
    tiles[2].isConnected = false;
    tiles[1].arrive();
    await settled();
    assert.deepEqual(loads(), [1, 1, 0, 1, 0, 0]);
    status = null;
    tiles[3].arrive();
    await settled();
    assert.deepEqual(loads().slice(0, 3), [1, 1, 0]);
    assert.equal(loads()[4], 1, 'one that fails passes its turn on while it pauses');
  },
});
