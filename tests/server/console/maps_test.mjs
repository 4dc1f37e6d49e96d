// The page's list of maps over several answers of the service: node maps_test.mjs FOLDER/OF/THE/PAGE
import assert from 'node:assert/strict';
import { load, run } from './page.mjs';

const { choiceOf, heightsOf, linesOf, stepTo } = await load('maps.js');

const ready = (name, version = '1', bbox = [38, 37, 39, 38]) => ({ name, version, status: 'ready', bbox });
const texts = (maps, chosen) => linesOf(maps, chosen).map((line) => line.text);

await run({
  'the first map with ground is chosen, then the choice stays'() {
    assert.equal(choiceOf([], ''), null);
    assert.equal(choiceOf([{ name: 'a', status: 'empty' }, ready('b'), ready('c')], ''), 'b');
    assert.equal(choiceOf([ready('a'), ready('b'), ready('c')], 'b'), 'b');
    assert.equal(choiceOf([ready('a')], 'b'), 'b');
  },
  'a map that is wished for is chosen if it can be shown'() {
    assert.equal(choiceOf([ready('a'), ready('b')], 'a', 'b'), 'b');
    assert.equal(choiceOf([ready('a'), ready('b')], '', 'b'), 'b');
    assert.equal(choiceOf([ready('a'), { name: 'b', status: 'empty' }], 'a', 'b'), 'a');
    assert.equal(choiceOf([ready('a')], '', 'b'), 'a');
    assert.equal(choiceOf([], '', 'b'), null);
  },
  'maps that cannot be shown say why and cannot be chosen'() {
    const maps = [{ name: 'a', status: 'empty' }, { name: 'b', status: 'unreadable', reason: 'cut off' }, { name: 'c', status: 'incomplete' }];
    assert.deepEqual(texts(maps, 'c'), ['a: nothing is ingested yet', 'b: cut off', 'c: still being ingested']);
    assert.deepEqual(linesOf(maps, 'c').map((line) => line.disabled), [true, true, false]);
  },
  'a damaged map says so and is shown as far as it goes'() {
    const maps = [{ ...ready('a'), status: 'damaged' }, { ...ready('b'), status: 'damaged', bbox: null }];
    assert.deepEqual(texts(maps, 'a'), ['a: parts of it are lost', 'b: parts of it are lost']);
    assert.deepEqual(linesOf(maps, 'a').map((line) => line.disabled), [false, true]);
  },
  'a map that appears gets a line, one that left loses it unless it is chosen'() {
    assert.deepEqual(texts([ready('a'), ready('b')], 'a'), ['a', 'b']);
    assert.deepEqual(texts([ready('b')], 'a'), ['b', 'a: no longer served']);
    assert.deepEqual(texts([ready('b')], 'b'), ['b']);
  },
  'a map is opened once and drawn anew when its version changes'() {
    assert.equal(stepTo([ready('a')], 'a', null), 'open');
    assert.equal(stepTo([ready('a')], 'a', { name: 'b', version: '1' }), 'open');
    assert.equal(stepTo([ready('a')], 'a', { name: 'a', version: null }), null);
    assert.equal(stepTo([ready('a')], 'a', { name: 'a', version: '1', heights: heightsOf({}) }), null);
    assert.equal(stepTo([ready('a', '2')], 'a', { name: 'a', version: '1', bbox: [38, 37, 38.5, 38] }), 'redraw');
    assert.equal(stepTo([], 'a', { name: 'a', version: '1' }), null);
    assert.equal(stepTo([], null, null), null);
    assert.equal(stepTo([{ name: 'a', version: '2', status: 'unreadable' }], 'a', { name: 'a', version: '1' }), null);
  },
  'a map tells the heights of its ground, and is drawn anew when they come, change or go'() {
    const terrain = { lowest_m: 501.7, highest_m: 518.2, known_share: 1 };
    assert.equal(heightsOf({ terrain }), 'ground 502 to 518 m above the sea');
    assert.equal(heightsOf({ terrain: { ...terrain, known_share: 0.478 } }), 'ground 502 to 518 m above the sea, known on 47 % of it');
    assert.equal(heightsOf({}), 'heights of the ground not known');
    const step = (was, now) => stepTo([{ ...ready('a'), ...now }], 'a', { ...ready('a'), heights: heightsOf(was) });
    assert.equal(step({}, {}), null);
    assert.equal(step({ terrain }, { terrain }), null);
    assert.equal(step({}, { terrain }), 'redraw');
    assert.equal(step({ terrain }, { terrain: { ...terrain, highest_m: 700 } }), 'redraw');
    assert.equal(step({ terrain }, {}), 'redraw');
  },
  'a map that is replaced by one of elsewhere is opened, so that the view goes there'() {
    const shown = { name: 'a', version: '1', bbox: [38, 37, 39, 38] };
    for (const bbox of [[40, 37, 41, 38], [36, 37, 37, 38], [38, 40, 39, 41], [38, 35, 39, 36]]) {
      assert.equal(stepTo([ready('a', '2', bbox)], 'a', shown), 'open');
    }
    assert.equal(stepTo([ready('a', '2', [38.5, 37.5, 50, 50])], 'a', shown), 'redraw');
  },
});
