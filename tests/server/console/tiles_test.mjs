// What the page does about tiles that did not come: node tiles_test.mjs FOLDER/OF/THE/PAGE
import assert from 'node:assert/strict';
import { load, run, service } from './page.mjs';

const { askAgain } = await load('tiles.js');

const pauses = [];
let atPause = () => {};
globalThis.setTimeout = (go, pause) => {
  pauses.push(pause);
  atPause(pauses.length);
  setImmediate(go);
};

/// A tile that failed; `loads` counts how often its picture was asked for since.
function failed() {
  pauses.length = 0;
  atPause = () => {};
  const tile = { dataset: {}, isConnected: true, loads: 0 };
  Object.defineProperty(tile, 'src', { get: () => '/tiles/1/2/3.png?version=1', set() { tile.loads += 1; } });
  return tile;
}

await run({
  async 'a tile that shows nothing is asked about once'() {
    const tile = failed();
    service.answers = { '/tiles/1/2/3.png': { status: 204 } };
    await askAgain({ tile });
    assert.equal(tile.loads, 0);
    assert.equal(pauses.length, 1);
  },
  async 'a tile is loaded as soon as the service answers again, after growing pauses'() {
    const tile = failed();
    service.answers = null;
    atPause = (count) => {
      if (count === 3) service.answers = { '/tiles/1/2/3.png': { status: 503 } };
      if (count === 6) service.answers = { '/tiles/1/2/3.png': { status: 200 } };
    };
    await askAgain({ tile });
    assert.equal(tile.loads, 1);
    assert.deepEqual(pauses, [1000, 2000, 4000, 8000, 10_000, 10_000]);
  },
  async 'a tile that has left the page is asked for no more'() {
    const tile = failed();
    service.answers = null;
    atPause = (count) => { tile.isConnected = count < 2; };
    await askAgain({ tile });
    assert.equal(tile.loads, 0);
    assert.equal(pauses.length, 2);
  },
  async 'a picture that is broken is loaded again after longer and longer pauses'() {
    const tile = failed();
    service.answers = { '/tiles/1/2/3.png': { status: 200 } };
    for (let i = 0; i < 3; i += 1) await askAgain({ tile });
    assert.equal(tile.loads, 3);
    assert.deepEqual(pauses, [1000, 2000, 4000]);
  },
});
